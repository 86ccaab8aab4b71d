"""What the body gains beyond this wheel's push."""

from __future__ import annotations

import math

import pytest
from msgspec.structs import replace

from tcs_hil.control.body_disturbance import LIMIT_MPS2, BodyDisturbance
from tcs_hil.control.driveline_nmpc import DrivelineOptimiser
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.vehicle import Vehicle
from tests.control.recorder import wheel_at

PERIOD_S = 0.002
VEHICLE = Vehicle()
PUSHING = replace(wheel_at(2.0, 0.1, 50.0), tyre_force_n=350.0, vehicle_accel_mps2=1.5)


@pytest.fixture
def disturbance() -> BodyDisturbance:
    return BodyDisturbance(VEHICLE, PERIOD_S)


def test_it_is_the_acceleration_that_two_such_wheels_do_not_explain(
    disturbance: BodyDisturbance,
) -> None:
    for _ in range(1000):
        disturbance.learn(PUSHING)
    assert disturbance.value_mps2 == pytest.approx(1.5 - 2.0 * 350.0 / 1400.0, abs=1e-3)


def test_no_sensor_fault_can_invent_more_than_a_road(disturbance: BodyDisturbance) -> None:
    for _ in range(1000):
        disturbance.learn(replace(PUSHING, vehicle_accel_mps2=1e6))
    assert disturbance.value_mps2 == pytest.approx(LIMIT_MPS2, abs=1e-3)


@pytest.mark.parametrize("unknown", ["tyre_force_n", "vehicle_accel_mps2"])
def test_what_nobody_knows_teaches_nothing(disturbance: BodyDisturbance, unknown: str) -> None:
    disturbance.learn(PUSHING)
    before = disturbance.value_mps2
    disturbance.learn(replace(PUSHING, **{unknown: math.nan}))
    assert disturbance.value_mps2 == before


def test_reset_forgets_it(disturbance: BodyDisturbance) -> None:
    disturbance.learn(PUSHING)
    disturbance.reset()
    assert disturbance.value_mps2 == 0.0


def test_a_wheel_on_ice_may_turn_faster_where_the_other_one_pulls_the_car() -> None:
    def torque_nm(accel_mps2: float) -> float:
        optimiser = DrivelineOptimiser(ControlSettings(), VEHICLE)
        for _ in range(200):
            optimiser.observe(replace(PUSHING, vehicle_accel_mps2=accel_mps2), 0.0)
        return float(optimiser.plan(50.0, 200.0).inputs[0])

    assert torque_nm(1.8) > torque_nm(0.5) + 0.1
