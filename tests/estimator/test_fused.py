"""The fused estimator from measurement to wheel states."""

from __future__ import annotations

import math

import pytest
from factories import ROLLING_RADPS, measurement

from tcs_hil.control.settings import ControlSettings
from tcs_hil.estimator.fused import FusedEstimator
from tcs_hil.model.vehicle import Vehicle

VEHICLE, RADIUS_M = Vehicle(), 0.318


@pytest.fixture
def estimator() -> FusedEstimator:
    return FusedEstimator(ControlSettings(), VEHICLE)


def test_a_rolling_car_has_its_speed_and_no_slip(estimator: FusedEstimator) -> None:
    for _ in range(100):
        estimate = estimator.update(measurement())
    assert estimate.vehicle_speed_mps == pytest.approx(ROLLING_RADPS * RADIUS_M)
    for wheel in estimate.wheels:
        assert wheel.slip_ratio == pytest.approx(0.0, abs=1e-6)
        assert wheel.tyre_force_n == pytest.approx(0.0, abs=1.0)


def test_each_wheel_is_seen_through_its_own_motor(estimator: FusedEstimator) -> None:
    m = measurement(motor_speed_radps=(66.0, 60.0), motor_torque_nm=(0.0, 0.0))
    for _ in range(200):
        left, right = estimator.update(m).wheels
    assert left.wheel_speed_radps == pytest.approx(22.0, abs=0.05)
    assert right.wheel_speed_radps == pytest.approx(20.0, abs=0.05)
    assert left.slip_ratio > 0.08 > right.slip_ratio


def test_steady_torque_at_steady_speed_is_the_tyres_force(estimator: FusedEstimator) -> None:
    for _ in range(300):
        wheel = estimator.update(measurement(motor_torque_nm=(80.0, 80.0))).wheels[0]
    assert wheel.tyre_force_n * RADIUS_M == pytest.approx(240.0, abs=1.0)
    assert wheel.shaft_twist_rad == pytest.approx(240.0 / 6000.0, abs=1e-3)


def test_without_fresh_motor_state_the_wheels_own_sensor_serves(estimator: FusedEstimator) -> None:
    estimator.update(measurement())
    silent = measurement(motor_age_s=0.02, wheel_speed_radps=(25.0, 20.0, 20.0, 20.0))
    left, right = estimator.update(silent).wheels
    assert left.wheel_speed_radps == 25.0
    assert left.slip_speed_mps == pytest.approx(5.0 * RADIUS_M)
    assert math.isnan(left.tyre_force_n)
    assert right.slip_ratio == pytest.approx(0.0)


def test_without_a_motor_a_wheel_is_as_fast_as_the_bodys_acceleration_has_made_it() -> None:
    estimator = FusedEstimator(ControlSettings(), VEHICLE)
    for tick in range(100):  # an edge every 20 ms, 2 m/s² in between
        shown_radps = ROLLING_RADPS + 0.04 / RADIUS_M * (tick // 10)
        wheels = (shown_radps,) * 4
        m = measurement(motor_age_s=0.02, accel_x_mps2=2.0, wheel_speed_radps=wheels)
        left, _ = estimator.update(m).wheels
    gained_mps = (left.wheel_speed_radps - shown_radps) * RADIUS_M
    assert gained_mps == pytest.approx(2.0 * (0.018 + 0.01), rel=0.1)


def test_an_invalid_wheel_keeps_its_last_good_speed(estimator: FusedEstimator) -> None:
    blind = {"motor_age_s": math.inf, "wheel_speed_valid": (False, True, True, True)}
    estimator.update(measurement())
    wheel = estimator.update(
        measurement(wheel_speed_radps=(0.0, 20.0, 20.0, 20.0), **blind)
    ).wheels[0]
    assert wheel.wheel_speed_radps == ROLLING_RADPS


def test_without_an_accelerometer_the_tyres_forces_stand_in(estimator: FusedEstimator) -> None:
    pushed = measurement(accel_x_mps2=math.nan, motor_torque_nm=(80.0, 80.0))
    speeds = [estimator.update(pushed).vehicle_speed_mps for _ in range(60)]
    assert speeds[-1] > speeds[0]


def test_the_road_and_the_delay_are_told(estimator: FusedEstimator) -> None:
    road = estimator.update(measurement()).road
    assert road.friction_ratio == (0.3, 0.3)
    assert road.confidence_ratio == (0.0, 0.0)
    assert road.loop_delay_s == ControlSettings().default.delay.delay_s
    assert estimator.newest.wheels[0].loop_delay_s == road.loop_delay_s
