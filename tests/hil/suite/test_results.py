"""What is kept of a suite: results.json and JUnit XML."""

from __future__ import annotations

from pathlib import Path

import pytest
from hil.suite.made import made_result, made_suite
from junitparser import JUnitXml

from tcs_hil.errors import ConfigError
from tcs_hil.hil.judging.verdict import Finding, Verdict
from tcs_hil.hil.suite.junit import write_junit
from tcs_hil.hil.suite.result import load_results

PASSED, FAILED, BLOCKED = Verdict


def test_results_are_read_back_as_they_were(tmp_path: Path) -> None:
    suite = made_suite(made_result("a/nmpc", PASSED), made_result("b/kmpc", FAILED))
    suite.save(tmp_path)
    assert load_results(tmp_path) == suite


@pytest.mark.parametrize("content", [None, "{", '{"title": "x"}'])
def test_a_folder_without_results_is_no_baseline(content: str | None, tmp_path: Path) -> None:
    if content is not None:
        (tmp_path / "results.json").write_text(content)
    with pytest.raises(ConfigError, match=r"results\.json"):
        load_results(tmp_path)


def test_the_reason_is_that_of_the_verdict() -> None:
    assert made_result("a/pi", PASSED).reason == ""
    assert made_result("a/pi", FAILED, BLOCKED).reason == "peak slip < 0.2: 0.3 at 1.000 s"
    assert made_result("a/pi", FAILED, FAILED).reason.endswith("(and 1 more)")
    assert made_result("a/pi", error="no bus").reason == "no bus"


def test_junit_has_a_test_case_for_every_limit(tmp_path: Path) -> None:
    suite = made_suite(
        made_result("a/nmpc", PASSED, FAILED, BLOCKED),
        made_result("b/nmpc", error="no bus"),
        made_result("c/nmpc", PASSED, suite="hill"),
    )
    write_junit(tmp_path / "junit.xml", suite)
    suites = {each.name: each for each in JUnitXml.fromfile(str(tmp_path / "junit.xml"))}
    launch = suites["launch"]
    assert (launch.tests, launch.failures, launch.errors) == (4, 1, 2)
    cases = list(launch)
    assert cases[0].classname == "launch.a.nmpc"
    assert [case.result[0].message for case in cases[1:]] == [
        "0.3 at 1.000 s",
        "blocked: needs a clock",
        "blocked: no bus",
    ]
    assert suites["hill"].tests == 1


def test_junit_that_cannot_be_written_is_refused_by_name(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="no-such-folder"):
        write_junit(tmp_path / "no-such-folder" / "junit.xml", made_suite())


def test_what_is_not_finite_survives_as_nothing(tmp_path: Path) -> None:
    never = Finding(
        limit="x", verdict=FAILED, reason="never reached", measured=float("inf"), unit="s"
    )
    suite = made_suite(made_result("a/pi", findings=[never]))
    suite.save(tmp_path)
    assert load_results(tmp_path).results[0].findings[0].measured is None
