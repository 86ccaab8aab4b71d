"""Every property of the campaign is one that a run can fail."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest
from hil.faults.records import calm, troubled

from tcs_hil.fault_codes import FaultCode
from tcs_hil.hil.faults import judge
from tcs_hil.hil.faults.cell import Cell
from tcs_hil.hil.faults.judge import CellJudge
from tcs_hil.hil.faults.promises import lost, nothing
from tcs_hil.hil.faults.record import Record
from tcs_hil.hil.faults.story import tell
from tcs_hil.hil.faults.suite import fault_case, fault_cells
from tcs_hil.hil.judging.evidence import Evidence
from tcs_hil.hil.judging.measured import CannotJudgeError
from tcs_hil.hil.judging.verdict import Finding, Verdict
from tcs_hil.hil.suite.runner import Bench, run_case
from tcs_hil.service.settings import ServiceConfig
from tcs_hil.signals import TcsState

LOST = lost(0.002, FaultCode.REAR_SPEED_LATE, FaultCode.REAR_SPEED_LOST)
CELL = Cell("dropped", ("WheelSpeedsRear",), "dropped", LOST, 0.1)
HARMLESS = Cell("dropped", ("TcsStatus",), "dropped", nothing("no decision rests on it"), 0.1)


class Ended:
    """The part of an `Evidence` that a judge reads besides the record."""

    config = ServiceConfig()
    clocked = False
    end_s = 1.198

    class scenario:  # noqa: N801 - stands for an attribute
        duration_s = 1.2


def findings(
    record: Record, monkeypatch: pytest.MonkeyPatch, cell: Cell = HARMLESS
) -> dict[str, Finding]:
    monkeypatch.setattr(judge, "read_record", lambda _evidence: record)
    found = CellJudge(cell)(Ended())  # type: ignore[arg-type]
    return {finding.limit.partition(" <=")[0].partition(":")[0]: finding for finding in found}


def failed(found: dict[str, Finding]) -> set[str]:
    return {name for name, finding in found.items() if finding.verdict is not Verdict.PASSED}


def answered() -> Record:
    """Late with the third missing tick, lost with the eleventh, back 20 ms after the fault."""
    record = troubled(TcsState.FAULT, FaultCode.REAR_SPEED_LOST, 352, 410)
    record.state[352:360] = TcsState.DEGRADED
    record.fault_code[352:360] = FaultCode.REAR_SPEED_LATE
    return record


def test_a_calm_run_fails_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    assert failed(findings(calm(), monkeypatch)) == set()


def test_a_fault_that_is_answered_in_time_passes_and_is_measured(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found = findings(answered(), monkeypatch, CELL)
    assert failed(found) == set()
    times = [found[name].measured for name in ("time to detect", "time to react", "time back")]
    assert times == [4.0, 20.0, 20.0]
    assert found["named"].reason == "REAR_SPEED_LATE, REAR_SPEED_LOST"


def test_at_real_pace_times_count_from_when_the_service_can_have_heard(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    record = answered()
    record.time_s[:] += 0.0025  # the phase and a period
    assert failed(findings(record, monkeypatch, CELL)) == {"time to detect", "time to react"}
    monkeypatch.setattr(Ended, "clocked", True)
    assert failed(findings(record, monkeypatch, CELL)) == set()
    assert failed(findings(calm(), monkeypatch)) == set()  # no time is owed, hence none later
    record.time_s[:] += 0.0025
    assert failed(findings(record, monkeypatch, CELL)) == {"time to detect", "time to react"}


def step_up(record: Record) -> None:
    record.limit_nm[400:, 1] = 141.0


def step_above_the_request(record: Record) -> None:
    record.request_nm[400:, 0] = 99.9


def no_number(record: Record) -> None:
    record.limit_nm[400, 0] = math.nan


def no_estimate(record: Record) -> None:
    record.estimate[400, 2] = math.inf


def below_zero(record: Record) -> None:
    record.limit_nm[400:402, 0] = -1.0
    record.wanted_nm[400:402, 0] = -1.0


def raised(record: Record) -> None:
    record.failed[400] = True


def never_in_control(record: Record) -> None:
    record.state[:350] = TcsState.INIT


@pytest.mark.parametrize(
    ("spoil", "what"),
    [
        (step_up, {"rise beyond its rate", "largest rise per tick"}),
        (step_above_the_request, {"limit above request"}),
        (no_estimate, {"not a number"}),
        (raised, {"failed ticks"}),
        (never_in_control, {"in control when the fault comes"}),
    ],
)
def test_each_property_can_be_broken(
    spoil: Callable[[Record], None], what: set[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    record = calm()
    spoil(record)
    assert failed(findings(record, monkeypatch)) == what


@pytest.mark.parametrize(
    ("spoil", "what"), [(no_number, "not a number"), (below_zero, "limit below zero")]
)
def test_a_limit_that_is_no_torque_fails(
    spoil: Callable[[Record], None], what: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    record = calm()
    spoil(record)
    assert what in failed(findings(record, monkeypatch))


def test_a_fault_that_is_not_answered_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    assert failed(findings(calm(), monkeypatch, CELL)) == {"time to detect", "time to react"}


def test_a_fault_that_is_answered_late_or_never_left_fails(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    record = troubled(TcsState.FAULT, FaultCode.REAR_SPEED_LOST, 362, 600)
    found = failed(findings(record, monkeypatch, CELL))
    assert found == {"time to detect", "time to react", "time back"}


def test_a_strange_name_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    record = answered()
    record.fault_code[380] = FaultCode.OVERRUNS
    found = findings(record, monkeypatch, CELL)
    assert failed(found) == {"named"}
    assert found["named"].reason == "OVERRUNS"


def test_what_need_not_be_found_says_why(monkeypatch: pytest.MonkeyPatch) -> None:
    found = findings(calm(), monkeypatch)
    assert found["time to detect"].reason == "no decision rests on it (never)"


def test_a_run_without_its_limits_is_blocked(monkeypatch: pytest.MonkeyPatch) -> None:
    def nothing_there(_evidence: Evidence) -> Record:
        raise CannotJudgeError("3 good limits on the bus, 4 ticks")

    monkeypatch.setattr(judge, "read_record", nothing_there)
    (finding,) = CellJudge(CELL)(Ended())  # type: ignore[arg-type]
    assert (finding.verdict, finding.reason) == (
        Verdict.BLOCKED,
        "3 good limits on the bus, 4 ticks",
    )


def test_a_state_that_comes_and_goes_is_back_only_after_its_last_time() -> None:
    record = troubled(TcsState.DEGRADED, FaultCode.REAR_SPEED_LATE, 352, 360)
    record.state[420] = TcsState.DEGRADED
    story = tell(record, TcsState.FAULT, 0.8)
    assert story.back_s == pytest.approx(0.042)
    assert story.answered_s is None


KINDS = {cell.kind: cell for cell in reversed(fault_cells())}
ROUNDS = [("kmpc", "manoeuvre-1"), ("nmpc", "manoeuvre-2"), ("pi", "manoeuvre-1")]


@pytest.mark.parametrize(
    ("kind", "law", "manoeuvre"),
    [(kind, *ROUNDS[number % 3]) for number, kind in enumerate(KINDS)],
)
def test_every_kind_of_fault_is_answered(
    kind: str, law: str, manoeuvre: str, tmp_path: Path
) -> None:
    case = fault_case(KINDS[kind], manoeuvre, law, ServiceConfig())  # type: ignore[arg-type]
    result = run_case(case, Bench("in-process", tmp_path))
    assert result.verdict is Verdict.PASSED, result.reason
