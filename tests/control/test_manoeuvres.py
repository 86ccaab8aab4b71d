"""The paper's two manoeuvres on its own quarter car, without delay: levels to hold."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tcs_hil.control.protocol import Controller
from tcs_hil.signals import ControllerKind
from tests.control.quarter_car import (
    GEAR,
    INERTIA_KGM2,
    MASS_KG,
    PERIOD_S,
    QuarterCar,
    Run,
    constant_friction,
    manoeuvre_1,
    manoeuvre_2,
)

Make = Callable[[ControllerKind], Controller]

FORTY_KMH = 40.0 / 3.6
"""Above it the published predictor leaves its data."""


@pytest.mark.parametrize(
    ("kind", "rmse", "peak"),
    [
        (ControllerKind.PI, 0.001, 0.11),
        (ControllerKind.KMPC, 0.006, 0.135),
        (ControllerKind.NMPC, 0.001, 0.11),
    ],
)
def test_manoeuvre_1_tracks_the_slip_reference(
    make: Make, kind: ControllerKind, rmse: float, peak: float
) -> None:
    run = manoeuvre_1(make(kind))
    assert run.tracking_rmse() <= rmse
    assert run.slip.max() <= peak


@pytest.mark.parametrize(
    ("kind", "rmse"),
    [(ControllerKind.PI, 0.012), (ControllerKind.KMPC, 0.012), (ControllerKind.NMPC, 0.010)],
)
def test_manoeuvre_2_tracks_through_the_friction_jumps(
    make: Make, kind: ControllerKind, rmse: float
) -> None:
    assert manoeuvre_2(make(kind)).tracking_rmse(below_mps=FORTY_KMH) <= rmse


def test_the_jump_to_high_friction_needs_all_the_motor_has(make: Make) -> None:
    run = manoeuvre_2(make(ControllerKind.NMPC))
    unreachable = ~run.reachable & (run.time_s > 0.6)
    assert run.slip[unreachable][-1] < 0.09
    assert run.torque_nm[unreachable].max() == pytest.approx(250.0)


@pytest.mark.parametrize("manoeuvre", [manoeuvre_1, manoeuvre_2])
def test_without_control_the_wheel_spins(
    make: Make, manoeuvre: Callable[[Controller], Run]
) -> None:
    assert manoeuvre(make(ControllerKind.OFF)).slip.max() > 0.9


def test_the_plant_turns_motor_work_into_motion_and_tyre_heat_and_nothing_else() -> None:
    car, torque_nm, work_j, heat_j = QuarterCar(constant_friction), 120.0, 0.0, 0.0
    start_j = kinetic_energy_j(car)
    for _ in range(500):
        speed, omega, slip_speed = car.speed_mps, car.wheel_radps, car.sensed(0.0).slip_speed_mps
        car.step(torque_nm)
        work_j += GEAR * torque_nm * PERIOD_S * (omega + car.wheel_radps) / 2
        impulse = MASS_KG / 4 * (car.speed_mps - speed)
        heat_j += impulse * (slip_speed + car.sensed(0.0).slip_speed_mps) / 2
    gained_j = kinetic_energy_j(car) - start_j
    assert work_j == pytest.approx(gained_j + heat_j, rel=1e-4)  # trapezia over 2 ms


def kinetic_energy_j(car: QuarterCar) -> float:
    return MASS_KG / 8 * car.speed_mps**2 + INERTIA_KGM2 / 2 * car.wheel_radps**2
