"""The believed cars behind the bank: physics, spread and timing."""

from __future__ import annotations

import numpy as np
import pytest

from tcs_hil.model.excitation import ExcitationSettings, excite, transitions
from tcs_hil.model.fleet import BODY, MOTOR, PATCH, TORQUE, TWIST, WHEEL, Fleet, FleetSettings
from tcs_hil.model.observables import Observable, Sample, lift, lift_one
from tcs_hil.model.vehicle import Vehicle

VEHICLE, PERIOD_S = Vehicle(), 0.002


def fleet(cars: int = 50, **settings: object) -> Fleet:
    drawn = FleetSettings(**settings)
    return Fleet.draw(VEHICLE, drawn, cars, np.random.default_rng(1))


def run(cars: Fleet, x: np.ndarray, torque_nm: np.ndarray, periods: int) -> np.ndarray:
    for _ in range(periods):
        x = cars.step(x, torque_nm, torque_nm, PERIOD_S)
    return x


def test_a_held_slip_stays_held_but_for_the_inertia_of_the_wheels() -> None:
    cars = fleet()
    start = cars.at_slip(np.full(50, 10.0), np.full(50, 0.05))
    end = run(cars, start, cars.holding_torque_nm(np.full(50, 0.05)), 250)
    # Spinning both inertias up with the car takes a few percent of the torque: the slip sinks.
    assert (end[PATCH] < 0.05).all()
    assert (end[PATCH] > 0.035).all()
    assert (end[BODY] > 10.5).all()


def test_motor_and_wheel_turn_together_once_the_shaft_has_settled() -> None:
    cars = fleet()
    start = cars.at_slip(np.full(50, 10.0), np.full(50, 0.03))
    end = run(cars, start, start[TORQUE], 500)
    np.testing.assert_allclose(end[MOTOR], end[WHEEL], atol=0.05)
    np.testing.assert_allclose(
        cars.stiffness * end[TWIST], VEHICLE.gear_ratio * end[TORQUE], rtol=0.05
    )


def test_the_motor_follows_its_command_with_its_lag() -> None:
    cars = fleet(arrival_share=(0.0, 0.01))
    start = cars.at_slip(np.full(50, 20.0), np.full(50, 0.02))
    step_nm = start[TORQUE] + 10.0
    after = cars.step(start, start[TORQUE], step_nm, PERIOD_S)
    expected = 10.0 * (1.0 - np.exp(-PERIOD_S / cars.lag_s))
    np.testing.assert_allclose(after[TORQUE] - start[TORQUE], expected, rtol=1e-3)


def test_a_command_that_arrives_late_acts_for_the_rest_of_its_period_only() -> None:
    prompt, late = fleet(arrival_share=(0.0, 0.01)), fleet(arrival_share=(0.5, 0.51))
    start = prompt.at_slip(np.full(50, 20.0), np.full(50, 0.02))
    before, command = start[TORQUE], start[TORQUE] + 10.0
    whole = prompt.step(start, before, command, PERIOD_S)[TORQUE] - before
    half = late.step(start, before, command, PERIOD_S)[TORQUE] - before
    assert (half > 0.4 * whole).all()
    assert (half < 0.6 * whole).all()


def test_parameters_stay_within_their_bounds_and_differ() -> None:
    cars = fleet()
    assert 3000.0 <= cars.stiffness.min() < cars.stiffness.max() <= 10_000.0
    assert 0.004 <= cars.lag_s.min() < cars.lag_s.max() <= 0.010


def test_bounds_that_do_not_rise_are_refused() -> None:
    with pytest.raises(ValueError, match="motor_lag_s must rise"):
        FleetSettings(motor_lag_s=(0.01, 0.004))


def test_excited_wheels_stay_around_the_slip_they_are_driven_at() -> None:
    cars = fleet(200)
    runs = excite(
        cars, ExcitationSettings(), np.full(200, 10.0), PERIOD_S, np.random.default_rng(2)
    )
    slip = transitions(runs, VEHICLE).z[:, Observable.SLIP_RATIO]
    assert np.median(slip) == pytest.approx(0.11, abs=0.04)
    assert (slip < 0.3).mean() > 0.8
    assert np.std(runs.command_nm) > 20.0


def test_lifting_one_wheel_equals_lifting_columns() -> None:
    now, before = Sample(0.4, 20.0, 20.1, 90.0), Sample(0.38, 19.9, 19.8, 88.0)
    columns = lift(
        Sample(*(np.array([value, value]) for value in now)),
        Sample(*(np.array([value, value]) for value in before)),
        VEHICLE,
    )
    np.testing.assert_array_equal(columns[1], lift_one(now, before, VEHICLE))
    assert columns[0, Observable.MOTOR_CHANGE] == pytest.approx(0.3)
    assert columns[0, Observable.TORQUE_BEFORE] == 88.0
