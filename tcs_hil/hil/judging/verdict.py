"""Passed, failed, or blocked: what could not be judged is never counted as passed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from enum import StrEnum

import msgspec

from tcs_hil.hil.judging.evidence import Evidence
from tcs_hil.hil.judging.limits import Check
from tcs_hil.hil.judging.measured import CannotJudgeError

NO_CLOCK = "needs a clock: run it with `--mode real-time`"


class Verdict(StrEnum):
    """What came of a limit, a case or a suite."""

    PASSED = "passed"
    FAILED = "failed"
    BLOCKED = "blocked"


class Finding(msgspec.Struct, frozen=True, kw_only=True):
    """One limit and what came of it.

    ``measured`` is the worst sample or the metric, ``at_s`` its time; both None
    where nothing was measured.
    """

    limit: str
    verdict: Verdict
    reason: str
    measured: float | None = None
    unit: str = ""
    at_s: float | None = None


def judge(checks: Sequence[Check], evidence: Evidence) -> list[Finding]:
    """Judge every limit on a run."""
    return [_judged(check, evidence) for check in checks]


def overall(verdicts: Iterable[Verdict]) -> Verdict:
    """Failed if anything failed; else blocked if anything is, or if there is nothing."""
    found = set(verdicts)
    if Verdict.FAILED in found:
        return Verdict.FAILED
    return Verdict.PASSED if found == {Verdict.PASSED} else Verdict.BLOCKED


def _judged(check: Check, evidence: Evidence) -> Finding:
    quantity = check.quantity
    if quantity.clocked and not evidence.clocked:
        return _blocked(check, NO_CLOCK)
    try:
        value, at_s, note = check.measured(evidence)
    except CannotJudgeError as error:
        return _blocked(check, str(error))
    place = "" if at_s is None else f" at {at_s:.3f} s"
    return Finding(
        limit=check.text,
        verdict=Verdict.PASSED if check.kept(value) else Verdict.FAILED,
        reason=f"{quantity.written(value)}{place}{f' ({note})' if note else ''}",
        measured=value,
        unit=quantity.unit,
        at_s=at_s,
    )


def _blocked(check: Check, reason: str) -> Finding:
    unit = check.quantity.unit
    return Finding(limit=check.text, verdict=Verdict.BLOCKED, reason=reason, unit=unit)
