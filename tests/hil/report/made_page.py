"""A page of two cases: one that was driven, and one whose run did not come about."""

from __future__ import annotations

from pathlib import Path

from hil.driven import launch
from hil.suite.made import made_result, made_suite

from tcs_hil.hil.judging.verdict import Verdict
from tcs_hil.hil.report import picture
from tcs_hil.hil.report.page import write_report
from tcs_hil.hil.suite.result import SuiteResult

DRIVEN, BROKEN = "launch/pi", "broken/pi"


def made_report(folder: Path, baseline: Path | None = None) -> Path:
    """Write the page, beside an earlier run if there is one."""
    run = folder / "runs" / DRIVEN
    run.mkdir(parents=True)
    picture.save(picture.take(launch()), run)
    before = None if baseline is None else (baseline, suite())
    return write_report(folder, suite(), before)


def suite() -> SuiteResult:
    """What the page is about; a reason that must not be taken for markup."""
    return made_suite(
        made_result(DRIVEN, Verdict.FAILED, Verdict.PASSED),
        made_result(BROKEN, error="no <b>bus</b></script>"),
    )
