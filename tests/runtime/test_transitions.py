"""What is logged of the states, and what is not."""

import logging

import pytest
from msgspec.structs import replace
from runtime.fakes import COMMAND

from tcs_hil.fault_codes import FaultCode
from tcs_hil.runtime.transitions import TransitionLog
from tcs_hil.signals import Command, TcsState

MS = 1_000_000
LATE = FaultCode.REAR_SPEED_LATE


def command(state: TcsState, code: FaultCode = FaultCode.NONE) -> Command:
    return replace(COMMAND, state=state, fault_code=code)


STANDBY, ACTIVE = command(TcsState.STANDBY), command(TcsState.ACTIVE)
DEGRADED = command(TcsState.DEGRADED, LATE)
FAULT = command(TcsState.FAULT, FaultCode.BUS_OFF)


@pytest.fixture
def log(caplog: pytest.LogCaptureFixture) -> TransitionLog:
    caplog.set_level(logging.INFO, "tcs_hil.runtime.transitions")
    return TransitionLog()


def test_a_transition_is_one_line_with_state_code_and_time(
    log: TransitionLog, caplog: pytest.LogCaptureFixture
) -> None:
    log.note(STANDBY, 1)
    log.note(DEGRADED, 7 * MS)
    log.note(DEGRADED, 9 * MS)
    assert caplog.records[-1].message == (
        "state=DEGRADED before=STANDBY code=12 fault=REAR_SPEED_LATE unlogged=0 time_ns=7000000"
    )
    assert len(caplog.records) == 2


def test_another_reason_for_the_same_state_is_news(
    log: TransitionLog, caplog: pytest.LogCaptureFixture
) -> None:
    log.note(DEGRADED, 1)
    log.note(command(TcsState.DEGRADED, FaultCode.OVERRUNS), 2)
    assert [r.message.split()[3] for r in caplog.records] == [
        "fault=REAR_SPEED_LATE",
        "fault=OVERRUNS",
    ]


def test_standby_and_active_are_one(log: TransitionLog, caplog: pytest.LogCaptureFixture) -> None:
    for tick, made in enumerate([STANDBY, ACTIVE, STANDBY, ACTIVE]):
        log.note(made, tick * 2 * MS)
    assert len(caplog.records) == 1


def test_the_level_tells_how_bad_it_is(
    log: TransitionLog, caplog: pytest.LogCaptureFixture
) -> None:
    for tick, made in enumerate([command(TcsState.INIT, LATE), STANDBY, DEGRADED, FAULT, STANDBY]):
        log.note(made, tick)
    assert [r.levelname for r in caplog.records] == ["INFO", "INFO", "WARNING", "ERROR", "WARNING"]


def test_a_flood_is_cut_off_counted_and_its_end_is_told(
    log: TransitionLog, caplog: pytest.LogCaptureFixture
) -> None:
    for tick in range(100):
        log.note(DEGRADED if tick % 2 else STANDBY, tick * 2 * MS)
    log.note(FAULT, 200 * MS)
    assert len(caplog.records) == 10
    log.note(FAULT, 1000 * MS - 1)
    assert len(caplog.records) == 10
    log.note(FAULT, 1000 * MS)
    assert "state=FAULT before=DEGRADED" in caplog.records[10].message
    assert "unlogged=90" in caplog.records[10].message


def test_what_came_and_went_during_a_flood_is_only_counted(
    log: TransitionLog, caplog: pytest.LogCaptureFixture
) -> None:
    for tick in range(10):
        log.note(DEGRADED if tick % 2 else STANDBY, tick)
    log.note(FAULT, 10)
    log.note(DEGRADED, 11)
    log.note(DEGRADED, 2000 * MS)
    assert len(caplog.records) == 10
    log.note(STANDBY, 2001 * MS)
    assert "unlogged=2" in caplog.records[10].message
