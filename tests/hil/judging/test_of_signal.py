"""Metrics of a signal, on signals whose answer is known by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tcs_hil.hil.judging.evidence import Series
from tcs_hil.hil.judging.measured import Measured
from tcs_hil.hil.judging.of_signal import SIGNAL_METRICS, Aim

TIME_S = np.arange(101) * 0.01
RAMP = Series(TIME_S, TIME_S)
"""From 0 to 1 in a second."""
STATES = Series(np.array([0.0, 0.1, 0.2, 0.6]), np.array([1.0, 5.0, 3.0, 4.0]))


def swing(amplitude: float, decay_s: float = 0.1) -> Series:
    """An answer to a step to 1 that rings down."""
    ringing = amplitude * np.exp(-TIME_S / decay_s) * np.cos(40.0 * TIME_S)
    return Series(TIME_S, 1.0 - ringing)


def measure(name: str, series: Series, aim: Aim = Aim()) -> Measured:  # noqa: B008 - a tuple
    return SIGNAL_METRICS[name].measure(series, aim)


def test_peak_and_lowest_come_with_their_time() -> None:
    series = Series(TIME_S, np.sin(2.0 * np.pi * TIME_S))
    assert measure("peak", series) == (pytest.approx(1.0), pytest.approx(0.25), "")
    assert measure("lowest", series) == (pytest.approx(-1.0), pytest.approx(0.75), "")


def test_mean_and_final_value() -> None:
    assert measure("mean", RAMP).value == pytest.approx(0.5)
    assert measure("final", RAMP) == (1.0, 1.0, "")


def test_rmse_is_the_distance_from_the_target() -> None:
    series = Series(TIME_S, np.where(np.arange(101) % 2, 0.3, 0.1))
    assert measure("RMSE", series, Aim(0.2)).value == pytest.approx(0.1)


def test_mean_rate_adds_up_every_way() -> None:
    there_and_back = Series(TIME_S, 1.0 - np.abs(1.0 - 2.0 * TIME_S))
    assert measure("mean rate", there_and_back).value == pytest.approx(2.0)


def test_overshoot_is_what_goes_beyond_the_target_from_either_side() -> None:
    assert measure("overshoot", swing(1.0), Aim(1.0)).value == pytest.approx(0.464, abs=0.005)
    fallen = Series(TIME_S, 1.0 - RAMP.values * 1.2)
    assert measure("overshoot", fallen, Aim(0.0)).value == pytest.approx(0.2)
    assert measure("overshoot", RAMP, Aim(2.0)).value == 0.0


def test_rise_time_is_from_10_to_90_percent_of_the_way() -> None:
    assert measure("rise time", RAMP, Aim(0.5)).value == pytest.approx(0.4)
    assert measure("rise time", RAMP, Aim(2.0)).value == math.inf


def test_settling_time_counts_the_last_time_outside_the_band() -> None:
    settled = measure("settling time", swing(1.0), Aim(1.0, 0.05))
    assert settled.value == pytest.approx(0.26, abs=0.02)
    assert measure("settling time", RAMP, Aim(0.2, 0.1)).value == math.inf
    assert measure("settling time", RAMP, Aim(0.5, 0.6)).value == 0.0


def test_time_in_range_adds_up_every_stay() -> None:
    assert measure("time in range", RAMP, Aim(0.5, 0.1)).value == pytest.approx(0.2, abs=0.011)


def test_time_to_reach_is_until_the_target_is_met_or_crossed() -> None:
    assert measure("time to reach", RAMP, Aim(0.305)).value == pytest.approx(0.31)
    assert measure("time to reach", RAMP, Aim(7.0)).value == math.inf


def test_a_state_is_reached_when_it_is_there_and_not_when_it_is_passed() -> None:
    assert measure("time to reach", STATES, Aim(3.0, exact=True)).value == pytest.approx(0.2)
    assert measure("time to reach", STATES, Aim(2.0, exact=True)).value == math.inf


def test_time_at_a_state_lasts_until_the_next_sample() -> None:
    assert measure("time at", STATES, Aim(3.0, exact=True)).value == pytest.approx(0.4)


def test_units_follow_the_signal_where_they_can() -> None:
    assert SIGNAL_METRICS["peak"].unit_for("Nm") == "Nm"
    assert SIGNAL_METRICS["mean rate"].unit_for("Nm") == "Nm/s"
    assert SIGNAL_METRICS["settling time"].unit_for("Nm") == "s"
