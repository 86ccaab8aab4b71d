"""The paper's plant: rigid driven wheels on a quarter of the car each, ideal in everything else.

Both driven wheels move one body, with the mean of their forces: with equal
limits that is the paper's quarter car, with unequal ones there is still one
vehicle speed.  The rear wheels roll freely.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plant_emulator.bounds import Positive, Table
from plant_emulator.compiled import compiled, records
from plant_emulator.inverter import Demand, Lines, demanded
from plant_emulator.road import MU_LEFT, MU_RIGHT, patch_at, time_to_edge
from plant_emulator.runge_kutta import STAGES, Work, blend, conclude, steps_for, work_for
from plant_emulator.truth import (
    ACCEL,
    BODY_SPEED,
    DISTANCE,
    FORCE,
    LOAD,
    MOTOR_SPEED,
    MOTOR_TORQUE,
    MU,
    SHAFT_TORQUE,
    SLIP_RATIO,
    SLIP_SPEED,
    SPECIFIC_FORCE,
    TYRE_SLIP,
    WHEEL_SPEED,
    Row,
)
from tcs_hil.signals import Pair

GRAVITY_MPS2 = 9.81

SPEED, WHEEL_LEFT, WHEEL_RIGHT, POSITION = range(4)


class QuarterCar(Table, frozen=True):
    """Parameters of the paper's Table I; ``mass_kg`` is the whole car's."""

    mass_kg: Positive = 1400.0
    wheel_radius_m: Positive = 0.318
    wheel_inertia_kgm2: Positive = 1.22
    gear_ratio: Positive = 3.0
    tyre_d: Positive = 1.2005
    tyre_c: Positive = 1.4010
    tyre_b: Positive = 17.1571
    slip_epsilon_m2ps2: Positive = 0.1


@compiled
def slip(car: QuarterCar, omega_radps: float, speed_mps: float) -> float:
    """Modified slip ratio, Eq. (slip_mod)."""
    rim_mps = omega_radps * car.wheel_radius_m
    return (rim_mps - speed_mps) * rim_mps / (rim_mps * rim_mps + car.slip_epsilon_m2ps2)


@compiled
def tyre_force(car: QuarterCar, kappa: float, mu: float) -> float:
    """Longitudinal force in N, Eq. (tire_model), at the static load m g / 4."""
    load_n = car.mass_kg * GRAVITY_MPS2 / 4.0
    return mu * load_n * car.tyre_d * math.sin(car.tyre_c * math.atan(car.tyre_b * kappa))


@compiled
def derivative(
    state: NDArray[np.float64],  # (4,)
    torque_nm: tuple[float, float],
    mu: tuple[float, float],
    car: QuarterCar,
    rate: NDArray[np.float64],  # (4,), written
) -> None:
    """Eq. (vw_nl_model) for both driven wheels."""
    total_n = 0.0
    for side in range(2):
        omega = state[WHEEL_LEFT + side]
        force_n = tyre_force(car, slip(car, omega, state[SPEED]), mu[side])
        wheel_torque_nm = car.gear_ratio * torque_nm[side]
        rate[WHEEL_LEFT + side] = (
            wheel_torque_nm - force_n * car.wheel_radius_m
        ) / car.wheel_inertia_kgm2
        total_n += force_n
    rate[SPEED] = 4.0 / car.mass_kg * 0.5 * total_n
    rate[POSITION] = state[SPEED]


class Moving(NamedTuple):
    """A car on its way, in one record: what it is, its state and where that is computed."""

    car: QuarterCar
    state: NDArray[np.float64]  # (4,)
    work: Work


@compiled
def advance(
    moving: Sequence[Moving],  # one
    lines: Lines,
    road: NDArray[np.float64],  # (patches, 5)
    duration_s: float,
) -> None:
    """Integrate with the classic Runge-Kutta method, in steps of at most 0.1 ms.

    A step ends where the car comes onto another patch of the road.
    """
    state, demand, steps = moving[0].state, Demand(*lines), steps_for(duration_s)
    longest_s = duration_s / steps
    for step in range(steps):
        left_s = longest_s
        while left_s > 0.0:
            h = min(left_s, time_to_edge(road, state[POSITION], state[SPEED], 0.0))
            piece = (step * longest_s + longest_s - left_s, h)
            _step(moving[0], demand, road, piece)
            left_s -= h


@compiled
def _step(moving: Moving, demand: Demand, road: NDArray[np.float64], piece: Pair) -> None:
    """One step on the road under the car; ``piece``: when on the demand's line, how long (s)."""
    elapsed_s, h = piece
    state, work = moving.state, moving.work
    patch = road[patch_at(road, state[POSITION])]
    mu = (patch[MU_LEFT], patch[MU_RIGHT])
    for stage in range(4):
        offset_s = STAGES[stage] * h
        blend(work.trial, state, offset_s, work.rates[stage - 1])
        torque_nm = demanded(demand, elapsed_s + offset_s)
        derivative(work.trial, torque_nm, mu, moving.car, work.rates[stage])
    conclude(state, h, work.rates)


class QuarterCarPlant:
    """State of a quarter car on a road; its sensors are ideal."""

    def __init__(self, car: QuarterCar, road: NDArray[np.float64], speed_mps: float) -> None:
        self._road = road
        omega = speed_mps / car.wheel_radius_m
        state = np.array([speed_mps, omega, omega, 0.0])
        self._moving = records(Moving(car, state, work_for(state.size)))

    def advance(self, demand: Demand, _time_s: float, duration_s: float) -> None:
        """Integrate over ``duration_s``."""
        advance(self._moving, tuple(demand), self._road, duration_s)

    def observe(self, demand: Demand, row: Row) -> None:
        """Fill in every state; what a quarter car has not (shaft, pitch, rear force) stays zero."""
        _observe(self._moving, tuple(demand), self._road, row)


@compiled
def _observe(moving: Sequence[Moving], lines: Lines, road: NDArray[np.float64], row: Row) -> None:
    car, state = moving[0].car, moving[0].state
    patch = road[patch_at(road, state[POSITION])]
    torque = demanded(Demand(*lines), 0.0)
    total_n = 0.0
    for wheel in range(4):
        driven, side = wheel < 2, wheel % 2
        row[MU + wheel] = mu = patch[MU_LEFT + side]
        row[LOAD + wheel] = car.mass_kg * GRAVITY_MPS2 / 4.0
        rolling = state[SPEED] / car.wheel_radius_m
        row[WHEEL_SPEED + wheel] = omega = state[WHEEL_LEFT + side] if driven else rolling
        row[SLIP_SPEED + wheel] = omega * car.wheel_radius_m - state[SPEED]
        row[SLIP_RATIO + wheel] = kappa = slip(car, omega, state[SPEED])
        if driven:
            row[TYRE_SLIP + wheel] = kappa
            row[FORCE + wheel] = tyre_force(car, kappa, mu)
            row[MOTOR_TORQUE + side] = torque[side]
            row[MOTOR_SPEED + side] = car.gear_ratio * omega
            row[SHAFT_TORQUE + side] = car.gear_ratio * torque[side]
            total_n += row[FORCE + wheel]
    row[DISTANCE], row[BODY_SPEED] = state[POSITION], state[SPEED]
    row[ACCEL] = row[SPECIFIC_FORCE] = 2.0 / car.mass_kg * total_n
