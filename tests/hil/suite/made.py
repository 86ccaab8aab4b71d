"""Results nobody had to drive for."""

from __future__ import annotations

from tcs_hil.hil.judging.verdict import Finding, Verdict, overall
from tcs_hil.hil.suite.result import Result, SuiteResult

REASONS = {
    Verdict.PASSED: "0.1 at 1.000 s",
    Verdict.FAILED: "0.3 at 1.000 s",
    Verdict.BLOCKED: "needs a clock",
}


def made_result(
    name: str,
    *verdicts: Verdict,
    suite: str = "launch",
    error: str = "",
    findings: list[Finding] | None = None,
) -> Result:
    """One case with a limit on the peak slip for every verdict."""
    found = [
        Finding(limit="peak slip < 0.2", verdict=each, reason=REASONS[each]) for each in verdicts
    ]
    found = found if findings is None else findings
    return Result(
        name=name,
        suite=suite,
        description="made up",
        controller=name.split("/")[1],
        preset="default",
        mode="lockstep",
        verdict=overall(each.verdict for each in found),
        findings=found,
        figures={"peak slip": 0.1, "slip RMSE": None},
        wall_s=1.5,
        error=error,
    )


def made_suite(*results: Result) -> SuiteResult:
    """A suite of such cases."""
    return SuiteResult(
        title="launch",
        command="tcs-hil hil --suite launch",
        started="2026-01-02T03:04:05+00:00",
        machine="a machine",
        versions={"python": "3"},
        jobs=1,
        wall_s=3.0,
        results=list(results),
    )
