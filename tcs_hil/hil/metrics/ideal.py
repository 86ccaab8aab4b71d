"""The speed the best conceivable controller would gain: the measure of those that exist."""

from __future__ import annotations

import math
from bisect import bisect_right

from plant_emulator.body import GRAVITY_MPS2
from plant_emulator.pedal import Pedal
from plant_emulator.road import FROM_M, PatchRow
from plant_emulator.scenario import Scenario
from tcs_hil.hil.metrics.ideal_car import IdealCar, ideal_car

STEP_S = 0.002
ROUNDS = 3
"""Load and acceleration depend on each other; a round leaves less than a quarter of the error."""


def ideal_speed_gained_mps(scenario: Scenario, duration_s: float) -> float:
    """Speed gained in ``duration_s`` with both front tyres always at the peak of their force.

    Quasi-static: the load on the tyres is the one under the acceleration they
    cause, and nothing slips, lags or relaxes.  The force is capped by what the
    driver's torque leaves after spinning the wheels up.  Friction is the
    scenario's at the place the ideal car has reached.  A real run may gain
    slightly more: its suspension moves.
    """
    car, pedal = ideal_car(scenario.vehicle), Pedal(scenario.driver)
    patches = [patch.row for patch in scenario.road]
    starts_m = [patch[FROM_M] for patch in patches]
    speed_mps, position_m, accel_mps2 = scenario.start_speed_mps, 0.0, 0.0
    for step in range(round(duration_s / STEP_S)):
        patch = patches[max(bisect_right(starts_m, position_m) - 1, 0)]
        request_nm = pedal.at(step * STEP_S).value
        for _ in range(ROUNDS):
            accel_mps2 = _acceleration(car, patch, request_nm, speed_mps, accel_mps2)
        position_m += speed_mps * STEP_S
        speed_mps = max(speed_mps + accel_mps2 * STEP_S, 0.0)  # at standstill the brakes hold
    return speed_mps - scenario.start_speed_mps


def _acceleration(
    car: IdealCar, patch: PatchRow, request_nm: float, speed_mps: float, guess_mps2: float
) -> float:
    """Acceleration under the load that ``guess_mps2`` leaves on the front wheels."""
    _, mu_left, mu_right, grade, _ = patch
    grade_cos = 1.0 / math.hypot(1.0, grade)
    weight_n = car.mass_kg * GRAVITY_MPS2
    against_n = car.drag_kgpm * speed_mps**2 + weight_n * grade * grade_cos
    load_n = car.load_n * grade_cos - car.shed_kg * (guess_mps2 + against_n / car.mass_kg)
    most_n = car.torque_force_n(request_nm, speed_mps, guess_mps2)
    force_n = min(car.peak_force_n(max(load_n, 0.0), mu_left), most_n)
    force_n += min(car.peak_force_n(max(load_n, 0.0), mu_right), most_n)
    # The driven wheels' resistance is between motor and tyre: it takes torque, not force.
    rolling_n = car.rolling_ratio * (weight_n * grade_cos - 2.0 * load_n)
    return (force_n - against_n - rolling_n) / (car.mass_kg + car.spin_kg)
