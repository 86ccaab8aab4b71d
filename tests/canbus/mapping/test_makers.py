"""Whole measurements and commands over the buses of three makers."""

from __future__ import annotations

import math

import pytest
from factories import command, measurement

from tcs_hil.service.bus_end import examine_map
from tcs_hil.signals import (
    NO_LIMIT,
    InputState,
    Measurement,
)

from .makers import AURELIS, MAKERS, MONTANE, QUENDAL, Car, Maker
from .mapped import node_of

PERIOD_NS = 2_000_000
SEEN = measurement(
    wheel_speed_radps=(12.34, 43.21, 20.0, 19.9),
    motor_speed_radps=(37.0, 130.0),
    motor_torque_nm=(120.5, -7.25),
    driver_torque_nm=(100.0, 100.0),
    accel_x_mps2=1.5,
)


def after(maker: Maker, ticks: int, seen: Measurement = SEEN) -> Measurement:
    """What the service has understood after some ticks of the maker's car."""
    node, car = node_of(maker), Car(maker)
    for tick in range(ticks):
        for frame_id, data in car.frames(seen):
            assert node.feed(frame_id, data, tick * PERIOD_NS)
    return node.measurement((ticks - 1) * PERIOD_NS)


def steps(maker: Maker, name: str) -> float:
    """Half a step of the signal, plus what floating point may lose."""
    plan, _ = examine_map(maker.config())
    return 0.5 * abs(plan.inputs[name].value.scale) + 1e-9


@pytest.mark.parametrize("maker", MAKERS, ids=lambda maker: maker.name)
def test_every_makers_frames_become_the_measurement_they_were_made_from(maker: Maker) -> None:
    seen = after(maker, 30)
    step = steps(maker, "wheel_speed_fl")
    assert seen.wheel_speed_radps == pytest.approx(SEEN.wheel_speed_radps, abs=step)
    assert seen.wheel_speed_valid == (True,) * 4
    driver = "driver_torque_axle" if maker is MONTANE else "driver_torque_left"
    assert seen.driver_torque_nm == pytest.approx(SEEN.driver_torque_nm, abs=steps(maker, driver))
    assert seen.front_speed_age_s == seen.rear_speed_age_s == 0.0
    assert seen.driver_age_s == pytest.approx(0.008)
    assert seen.front_speed_state is seen.rear_speed_state is seen.driver_state is InputState.VALID


@pytest.mark.parametrize("maker", [MONTANE, AURELIS], ids=lambda maker: maker.name)
def test_motors_and_acceleration_come_over_where_the_bus_has_them(maker: Maker) -> None:
    seen = after(maker, 30)
    step_radps, step_nm = steps(maker, "motor_speed_left"), steps(maker, "motor_torque_left")
    assert seen.motor_speed_radps == pytest.approx(SEEN.motor_speed_radps, abs=step_radps)
    assert seen.motor_torque_nm == pytest.approx(SEEN.motor_torque_nm, abs=step_nm)
    assert seen.accel_x_mps2 == pytest.approx(1.5, abs=steps(maker, "accel_x"))
    assert seen.motor_age_s == 0.0
    assert seen.motor_state is InputState.VALID


def test_what_a_bus_does_not_have_was_never_received() -> None:
    seen = after(QUENDAL, 30)
    assert seen.motor_age_s == math.inf
    assert math.isnan(seen.accel_x_mps2)


@pytest.mark.parametrize("maker", MAKERS, ids=lambda maker: maker.name)
@pytest.mark.parametrize("limits", [(40.0, 55.5), (NO_LIMIT, 0.0), (NO_LIMIT, NO_LIMIT)])
def test_every_maker_understands_the_limits(maker: Maker, limits: tuple[float, float]) -> None:
    node, car = node_of(maker), Car(maker)
    for tick in range(20):  # all counters come round
        ((frame_id, data),) = node.frames(command(*limits), tick * PERIOD_NS)
        understood = car.limits(frame_id, data)
        assert understood is not None
        assert understood == pytest.approx(limits, abs=0.13)  # half of Montane's quarter Nm
