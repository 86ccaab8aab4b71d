"""The paper's two manoeuvres on its own quarter car, without delay: levels to hold."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from tcs_hil.control.protocol import Controller
from tcs_hil.signals import ControllerKind
from tests.control.quarter_car import manoeuvre_1, manoeuvre_2

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
def test_without_control_the_wheel_spins(make: Make, manoeuvre: Callable[..., object]) -> None:
    run = manoeuvre(make(ControllerKind.OFF))
    assert run.slip.max() > 0.9  # type: ignore[attr-defined]


def test_the_plant_keeps_its_energy() -> None:
    """Motor work ends as kinetic energy or as heat in the contact patch; nothing else."""
    from tests.control.quarter_car import GEAR, INERTIA_KGM2, MASS_KG, PERIOD_S, QuarterCar

    car, work, heat = QuarterCar(lambda _: 0.3), 0.0, 0.0
    energy = car_energy(car, MASS_KG, INERTIA_KGM2)
    for _ in range(500):
        before, slip_before, slip_speed = car.wheel_radps, car.speed_mps, car.sensed(0.0)
        car.step(120.0)
        work += GEAR * 120.0 * PERIOD_S * (before + car.wheel_radps) / 2
        force = MASS_KG / 4 * (car.speed_mps - slip_before) / PERIOD_S
        mean_slip_speed = (slip_speed.slip_speed_mps + car.sensed(0.0).slip_speed_mps) / 2
        heat += force * mean_slip_speed * PERIOD_S
    gained = car_energy(car, MASS_KG, INERTIA_KGM2) - energy
    assert math.isclose(work, gained + heat, rel_tol=1e-4)


def car_energy(car: object, mass_kg: float, inertia_kgm2: float) -> float:
    return mass_kg / 8 * car.speed_mps**2 + inertia_kgm2 / 2 * car.wheel_radps**2  # type: ignore[attr-defined]
