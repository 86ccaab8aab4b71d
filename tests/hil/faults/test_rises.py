"""How fast a limit may rise, judged without the gate."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hil.faults.records import calm, troubled

from tcs_hil.hil.faults.record import Record
from tcs_hil.hil.faults.rises import allowed_nm, beyond_window_nm, rises_nm
from tcs_hil.safety_settings import GateSettings, SupervisorSettings
from tcs_hil.signals import NO_LIMIT, TcsState

GATE = GateSettings()
DEGRADED, FAULT = TcsState.DEGRADED, TcsState.FAULT


def allowed(record: Record, tick: int) -> float:
    """Most that the left limit may rise from the tick before ``tick`` on."""
    return float(allowed_nm(record, GATE, SupervisorSettings())[tick - 1, 0])


def test_a_trusted_law_may_raise_by_its_rate() -> None:
    assert allowed(calm(), 400) == pytest.approx(40.0)


@pytest.mark.parametrize("state", [DEGRADED, FAULT, TcsState.INIT])
def test_in_every_other_state_the_release_rate_holds(state: TcsState) -> None:
    record = troubled(state, 52, 360, 400)
    assert [allowed(record, tick) for tick in (359, 360, 399)] == pytest.approx([40.0, 1.0, 1.0])


@pytest.mark.parametrize(
    ("ages", "age_s"), [("wheel_age_s", 0.006), ("driver_age_s", 0.030)], ids=["wheel", "request"]
)
def test_while_an_input_is_awaited_nothing_may_rise(ages: str, age_s: float) -> None:
    record = troubled(DEGRADED, 12, 360, 400)
    getattr(record, ages)[360:370] = age_s
    assert [allowed(record, tick) for tick in (369, 370)] == pytest.approx([0.0, 1.0])


def test_what_was_lost_may_be_released() -> None:
    record = troubled(FAULT, 22, 360, 400)
    record.wheel_age_s[360:400] = 0.1
    assert allowed(record, 380) == pytest.approx(1.0)


def test_a_law_that_is_trusted_again_may_not_step_before_it_has_been_met() -> None:
    record = troubled(DEGRADED, 52, 360, 400)
    record.wanted_nm[:420] = 110.0
    assert [allowed(record, tick) for tick in (418, 419, 420)] == pytest.approx([1.0, 1.0, 40.0])


def test_a_limit_that_is_lifted_rises_to_the_request() -> None:
    record = calm()
    record.limit_nm[500:] = NO_LIMIT
    rises = rises_nm(record)
    assert rises[499].tolist() == [150.0, 150.0]
    assert np.isneginf(rises[500]).all()


def test_small_rises_may_add_up_to_no_more_than_the_window() -> None:
    record = calm()
    record.limit_nm[400:410] += np.arange(1, 11)[:, np.newaxis] * 21.0
    beyond = beyond_window_nm(record, GATE)
    assert beyond.max() == pytest.approx(10.0)
    assert np.argmax(beyond[:, 0]) == 408


def test_the_window_begins_anew_where_there_was_no_limit() -> None:
    record = calm()
    record.limit_nm[400:410] = NO_LIMIT
    record.limit_nm[410] = 340.0
    record.limit_nm[411:] = 345.0
    assert beyond_window_nm(record, GATE).max() == 5.0 - GATE.window_rise_nm


def test_a_run_without_limits_has_no_rise() -> None:
    record = calm()
    record.limit_nm[:] = math.inf
    assert np.isneginf(rises_nm(record)).all()
    assert np.isneginf(beyond_window_nm(record, GATE)).all()
