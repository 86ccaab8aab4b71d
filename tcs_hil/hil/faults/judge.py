"""Judges a cell of the campaign: the safety properties on every tick, then what it was promised."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from tcs_hil.hil.faults.cell import Cell, Promise
from tcs_hil.hil.faults.manoeuvres import FAULT_S
from tcs_hil.hil.faults.record import FloatArray, Record, read_record
from tcs_hil.hil.faults.rises import RESOLUTION_NM, allowed_nm, beyond_window_nm, rises_nm
from tcs_hil.hil.faults.story import HALF_TICK_S, Story, tell
from tcs_hil.hil.judging.evidence import Evidence
from tcs_hil.hil.judging.measured import CannotJudgeError
from tcs_hil.hil.judging.verdict import Finding, Verdict
from tcs_hil.hil.run import SERVICE_PHASE_US
from tcs_hil.supervisor import PERIOD_S

ABOVE = "limit above request"
BEYOND = "rise beyond its rate"
NAMED = "named"
DETECT = "time to detect"
REACT = "time to react"
RISE = "largest rise per tick"
BACK = "time back"
MS = 1e3

ROUNDED_NM = RESOLUTION_NM / 2 + 1e-9
"""The bus has steps; the gate, which has none, keeps the request exactly."""

HEARD_S = SERVICE_PHASE_US * 1e-6 + PERIOD_S
"""At real pace a frame may still be on the wire when the service ticks: the next tick hears it."""


@dataclass(frozen=True, slots=True)
class CellJudge:
    """Judges the runs of one cell."""

    cell: Cell

    def __call__(self, evidence: Evidence) -> list[Finding]:
        """Judge one run; what cannot be judged is blocked, never passed."""
        try:
            record = read_record(evidence)
        except CannotJudgeError as error:
            return [Finding(limit="recorded", verdict=Verdict.BLOCKED, reason=str(error))]
        story = tell(record, self.cell.promise.state, self.cell.end_s)
        promise = _at_real_pace(self.cell.promise) if evidence.clocked else self.cell.promise
        return [*_always(record, evidence), *_promised(promise, story)]


def _at_real_pace(promise: Promise) -> Promise:
    """The same, with every time counted from when the service can have heard."""
    owed_s = promise.named_s, promise.within_s
    named_s, within_s = (None if each is None else each + HEARD_S for each in owed_s)
    return replace(promise, named_s=named_s, within_s=within_s, back_s=promise.back_s + HEARD_S)


def _always(record: Record, evidence: Evidence) -> Iterator[Finding]:
    """What holds in every tick, whatever the fault."""
    gate, time_s = evidence.config.gate, record.time_s
    limited = np.where(np.isposinf(record.limit_nm), 0.0, record.limit_nm)
    numbers = np.column_stack((record.estimate, limited))
    yield _worst(ABOVE, "Nm", _above_request(record), ROUNDED_NM, time_s)
    yield _worst("limit below zero", "Nm", -limited, 0.0, time_s)
    yield _worst("not a number", "", (~np.isfinite(numbers)).astype(float), 0.0, time_s)
    rises = rises_nm(record)
    excess = rises - allowed_nm(record, gate, evidence.config.supervisor)
    yield _worst(BEYOND, "Nm", excess, RESOLUTION_NM, time_s[1:])
    window = beyond_window_nm(record, gate)
    yield _worst("rise beyond its window", "Nm", window, RESOLUTION_NM, time_s[1:])
    after = time_s[1:] >= FAULT_S - HALF_TICK_S
    most_nm = gate.rise_rate_nmps * PERIOD_S
    yield _worst(RISE, "Nm", rises[after], most_nm + RESOLUTION_NM, time_s[1:][after])
    yield _worst("failed ticks", "", record.failed.astype(float), 0.0, time_s)
    yield _ended(evidence)


def _above_request(record: Record) -> FloatArray:
    request_nm = np.maximum(record.request_nm, 0.0)
    return np.where(np.isposinf(record.limit_nm), -np.inf, record.limit_nm - request_nm)


def _ended(evidence: Evidence) -> Finding:
    short_s = evidence.scenario.duration_s - evidence.end_s
    verdict = Verdict.PASSED if short_s < 2 * PERIOD_S else Verdict.FAILED
    reason = f"at {evidence.end_s:.3f} s"
    return Finding(limit="runs to its end", verdict=verdict, reason=reason)


def _worst(name: str, unit: str, values: FloatArray, most: float, time_s: FloatArray) -> Finding:
    """Judge the largest of ``values`` (n, ...), which belong to ``time_s`` (n,)."""
    per_tick = values.reshape(len(values), -1).max(axis=1)
    tick = int(np.argmax(per_tick))
    worst = max(float(per_tick[tick]), 0.0)  # a limit that falls does not rise
    kept = not np.isnan(per_tick).any() and worst <= most
    return Finding(
        limit=f"{name} <= {most:g} {unit}".rstrip(),
        verdict=Verdict.PASSED if kept else Verdict.FAILED,
        reason=f"{worst:.4g} {unit} at {time_s[tick]:.3f} s",
        measured=worst,
        unit=unit,
        at_s=float(time_s[tick]),
    )


def _promised(promise: Promise, story: Story) -> Iterator[Finding]:
    """What this fault was promised."""
    before = Verdict.PASSED if story.settled_before else Verdict.BLOCKED
    yield Finding(limit="in control when the fault comes", verdict=before, reason="")
    strange = [code.name for code in story.codes if code not in promise.codes]
    yield Finding(
        limit=NAMED,
        verdict=Verdict.FAILED if strange else Verdict.PASSED,
        reason=", ".join(strange or [code.name for code in story.codes]),
    )
    yield _in_time(DETECT, story.named_s, promise.named_s, promise.why)
    yield _in_time(REACT, story.answered_s, promise.within_s, promise.why)
    back_s = np.inf if story.back_s is None else story.back_s
    yield _in_time(BACK, back_s, promise.back_s, "")


def _in_time(name: str, measured_s: float | None, within_s: float | None, why: str) -> Finding:
    measured_ms = None if measured_s is None else round(measured_s * MS, 3)
    took = "never" if measured_ms is None else f"{measured_ms:g} ms"
    if within_s is None:
        return Finding(
            limit=f"{name}: none is owed",
            verdict=Verdict.PASSED,
            reason=f"{why} ({took})",
            measured=measured_ms,
            unit="ms",
        )
    kept = measured_ms is not None and measured_ms <= within_s * MS
    return Finding(
        limit=f"{name} <= {within_s * MS:g} ms",
        verdict=Verdict.PASSED if kept else Verdict.FAILED,
        reason=took,
        measured=measured_ms,
        unit="ms",
    )
