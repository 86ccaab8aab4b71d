"""Verdicts as JUnit XML, for a CI server: a suite per folder, a test case per limit."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import groupby
from pathlib import Path

from junitparser import Error, Failure, JUnitXml, TestCase, TestSuite

from tcs_hil.errors import ConfigError
from tcs_hil.hil.judging.verdict import Finding, Verdict
from tcs_hil.hil.suite.result import Result, SuiteResult


def write_junit(path: Path, suite: SuiteResult) -> None:
    """Write the file; what is blocked is an error, so that nobody takes it for passed.

    Raises:
        ConfigError: the file cannot be written.
    """
    xml = JUnitXml(suite.title)
    by_suite = sorted(suite.results, key=lambda result: result.suite)
    for name, results in groupby(by_suite, key=lambda result: result.suite):
        xml.append(_suite(name, results))  # type: ignore[no-untyped-call]
    try:
        xml.write(str(path), pretty=True)
    except OSError as error:
        raise ConfigError(f"{path}: cannot be written ({error.strerror})") from error


def _suite(name: str, results: Iterable[Result]) -> TestSuite:
    suite = TestSuite(name)
    for result in results:
        for case in _cases(result):
            suite.add_testcase(case)
    suite.update_statistics()  # type: ignore[no-untyped-call]
    return suite


def _cases(result: Result) -> Iterator[TestCase]:
    if not result.findings:
        case = TestCase("run", classname=_class_name(result), time=result.wall_s)
        case.result = [Error(f"blocked: {result.reason}", "blocked")]
        yield case
    for finding in result.findings:
        case = TestCase(finding.limit, classname=_class_name(result), time=_share_s(result))
        case.result = list(_outcome(finding))
        yield case


def _outcome(finding: Finding) -> Iterator[Failure | Error]:
    if finding.verdict is Verdict.FAILED:
        yield Failure(finding.reason, "limit")
    elif finding.verdict is Verdict.BLOCKED:
        yield Error(f"blocked: {finding.reason}", "blocked")


def _class_name(result: Result) -> str:
    """Dots separate, as CI servers build a tree from them."""
    return f"{result.suite}.{result.name.replace('/', '.')}"


def _share_s(result: Result) -> float:
    """One run answers all of its limits."""
    return round(result.wall_s / len(result.findings), 3)
