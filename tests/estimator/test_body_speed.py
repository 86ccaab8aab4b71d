"""Body speed between the edges of toothed wheels."""

from __future__ import annotations

import numpy as np
import pytest

from tcs_hil.estimator.body_speed import BodySpeed
from tests.estimator.wheel_sensor import PERIOD_S, toothed

GOOD = (True, True)


def launch(time_s: float) -> float:
    """2 km/h, then 1.5 m/s²."""
    return 0.556 + 1.5 * max(time_s - 0.5, 0.0)


def errors(bias_mps2: float, accel: bool = True) -> np.ndarray:
    body, rows = BodySpeed(PERIOD_S), []
    for time_s, shown_mps in toothed(launch, 3.0):
        felt = (1.5 if time_s > 0.5 else 0.0) + bias_mps2 if accel else 0.0
        rows.append(
            body.update((shown_mps, shown_mps), GOOD, felt, launch(time_s)) - launch(time_s)
        )
    return np.array(rows)[500:]


def test_the_accelerometer_bridges_the_time_between_edges() -> None:
    shown = np.array([speed - launch(time_s) for time_s, speed in toothed(launch, 3.0)])[500:]
    fused = errors(0.0)
    assert fused.std() < 0.008
    assert fused.std() < 0.5 * shown.std()


def test_a_bias_of_the_accelerometer_is_learnt() -> None:
    assert np.abs(errors(0.3)[500:]).max() < 0.02


def test_the_grade_under_a_car_that_is_met_rolling_is_learnt_within_half_a_second() -> None:
    body, speeds_mps = BodySpeed(PERIOD_S), []
    for time_s, shown_mps in toothed(lambda time_s: 6.0 + 1.5 * time_s, 0.6):
        body.update((shown_mps, shown_mps), GOOD, 0.5, 6.0)  # 1 m/s² less than there is
        speeds_mps.append(body.value_mps - (6.0 + 1.5 * time_s))
    assert np.abs(speeds_mps[-50:]).max() < 0.03
    assert body.accel_mps2 == pytest.approx(1.5, abs=0.25)


def test_without_acceleration_the_wheels_alone_are_followed() -> None:
    assert np.abs(errors(0.0, accel=False)).max() < 0.25
    assert np.abs(errors(0.0, accel=False)[500:]).mean() < 0.05


def test_the_first_speed_is_taken_as_it_is() -> None:
    assert BodySpeed(PERIOD_S).update((5.0, 7.0), GOOD, 0.0, 6.0) == 6.0


def test_nothing_is_believed_before_a_wheel_vouches_for_itself() -> None:
    body = BodySpeed(PERIOD_S)
    assert body.update((5.0, 7.0), (False, False), 3.0, 5.0) == 0.0
    assert body.update((5.0, 7.0), (False, True), 3.0, 5.0) == 7.0


def test_a_wheel_that_does_not_vouch_for_itself_is_left_out() -> None:
    body = BodySpeed(PERIOD_S)
    body.update((5.0, 5.0), GOOD, 0.0, 5.0)
    for tick in range(500):
        speed = body.update((90.0 + tick, 5.0 + 1e-6 * tick), (False, True), 0.0, 5.0)
    assert speed == pytest.approx(5.0, abs=0.01)


def test_a_car_that_stands_is_believed_to_stand() -> None:
    body = BodySpeed(PERIOD_S)
    body.update((0.3, 0.3), GOOD, 0.0, 0.3)
    for _ in range(2000):
        speed = body.update((0.0, 0.0), GOOD, 0.1, 0.0)
    assert speed < 0.02


def test_a_car_that_moves_off_is_not_held_back_by_wheels_that_still_show_zero() -> None:
    body, errors_mps = BodySpeed(PERIOD_S), []
    for tick in range(350):
        time_s = max((tick - 150) * PERIOD_S, 0.0)  # 0.3 s of rest, then a ramp of 3 m/s³
        shown = 0.05 if time_s > 0.35 else 0.0  # the first edge: a mean over nobody knows how long
        speed = 1.5 * time_s**2
        motors = speed + (0.05 if time_s > 0.0 else 0.0)  # they wind up shafts and tyres first
        seen = body.update((shown, shown), GOOD, 0.3 + 3.0 * time_s, motors)
        errors_mps.append(seen - speed)
    assert np.abs(errors_mps).max() < 0.01


def test_front_wheels_that_spin_on_a_standing_car_do_not_make_it_move_for_ever() -> None:
    body = BodySpeed(PERIOD_S)
    body.update((0.0, 0.0), GOOD, 0.0, 0.0)
    for _ in range(5000):
        speed = body.update((0.0, 0.0), GOOD, 0.1, 5.0)
    assert speed < 0.1
