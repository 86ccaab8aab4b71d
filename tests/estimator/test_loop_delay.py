"""The delay of the loop, measured from the motors' own torque."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tcs_hil.control.settings import DelaySettings
from tcs_hil.estimator.loop_delay import CANDIDATES, SLEW, LoopDelay

PERIOD_S, LAG_S, REQUEST = 0.002, 0.005, (200.0, 200.0)


def torque_nm(time_s: float) -> float:
    """What a loop at work sends: slow moves and some ripple."""
    return 120.0 + 30.0 * math.sin(12.0 * time_s) + 10.0 * math.sin(70.0 * time_s)


def measured(
    delay_s: float, lag_s: float = LAG_S, duration_s: float = 3.0, start_s: float = 0.006
) -> list[float]:
    """Estimates over time; both motors echo with the delay, a lag and sensor noise."""
    estimate = LoopDelay(DelaySettings(delay_s=start_s), LAG_S, PERIOD_S)
    rng, echo_nm, h = np.random.default_rng(2), 120.0, PERIOD_S / 20
    values = []
    for tick in range(round(duration_s / PERIOD_S)):
        values.append(estimate.heard((echo_nm + 0.25 * rng.standard_normal(), echo_nm)))
        sent_nm = torque_nm(tick * PERIOD_S)
        estimate.sent((sent_nm, sent_nm), REQUEST)
        for step in range(20):  # a command is held for a period and acts after the delay
            held_s = math.floor((tick * PERIOD_S + step * h - delay_s) / PERIOD_S + 1e-9) * PERIOD_S
            echo_nm += h / lag_s * (torque_nm(held_s) - echo_nm)
    return values


@pytest.mark.parametrize("delay_ms", [0.0, 3.0, 6.0, 9.4, 16.0])
def test_the_delay_is_found_to_a_fraction_of_a_period(delay_ms: float) -> None:
    assert measured(delay_ms / 1e3)[-1] == pytest.approx(delay_ms / 1e3, abs=5e-4)


def test_the_estimate_moves_slowly() -> None:
    steps = np.abs(np.diff(measured(0.016)))
    assert steps.max() <= SLEW * PERIOD_S + 1e-12


@pytest.mark.parametrize("lag_ms", [2.0, 20.0])
def test_a_motor_of_another_lag_shows_as_delay_within_bounds(lag_ms: float) -> None:
    delay_s = measured(0.006, lag_s=lag_ms / 1e3)[-1]
    assert 0.0 <= delay_s <= (CANDIDATES - 1) * PERIOD_S
    assert delay_s == pytest.approx(0.006 + lag_ms / 1e3 - LAG_S, abs=6e-3)


def test_nothing_is_learnt_while_the_driver_decides() -> None:
    estimate = LoopDelay(DelaySettings(delay_s=0.006), LAG_S, PERIOD_S)
    for tick in range(1000):
        request = torque_nm(tick * PERIOD_S)
        estimate.heard((request, request))
        estimate.sent((request, request), (request, request))
    assert estimate.value_s == 0.006


def test_nothing_is_learnt_from_a_steady_torque() -> None:
    estimate = LoopDelay(DelaySettings(delay_s=0.006), LAG_S, PERIOD_S)
    for _ in range(1000):
        estimate.heard((100.0, 100.3))
        estimate.sent((100.0, 100.0), REQUEST)
    assert estimate.value_s == 0.006


def test_a_configured_delay_is_believed() -> None:
    estimate = LoopDelay(DelaySettings(delay_s=0.004, measured=False), LAG_S, PERIOD_S)
    for tick in range(1000):
        echo = torque_nm((tick - 6) * PERIOD_S)
        assert estimate.heard((echo, echo)) == 0.004
        sent = torque_nm(tick * PERIOD_S)
        estimate.sent((sent, sent), REQUEST)
