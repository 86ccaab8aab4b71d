"""The paper's plant: rigid driven wheels on a quarter of the car each, ideal in everything else.

Both driven wheels move one body, with the mean of their forces: with equal
limits that is the paper's quarter car, with unequal ones there is still one
vehicle speed.  The rear wheels roll freely.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from plant_emulator.bounds import Positive, Table
from plant_emulator.compiled import compiled, record
from plant_emulator.inverter import Demand, demanded
from plant_emulator.road import MU_LEFT, MU_RIGHT, patch_at
from plant_emulator.truth import Truth

GRAVITY_MPS2 = 9.81
MAX_STEP_S = 1e-4

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


@compiled
def advance(
    state: NDArray[np.float64],  # (4,), advanced in place
    demand: Demand,
    car: QuarterCar,
    road: NDArray[np.float64],  # (patches, 5)
    duration_s: float,
) -> None:
    """Integrate with the classic Runge-Kutta method, in steps of at most 0.1 ms.

    Friction is that of the patch at the beginning of a step.
    """
    steps = max(1, math.ceil(duration_s / MAX_STEP_S - 1e-6))
    h = duration_s / steps
    rates = np.empty((4, state.size))
    for step in range(steps):
        patch = road[patch_at(road, state[POSITION])]
        mu = (patch[MU_LEFT], patch[MU_RIGHT])
        start_s = step * h
        middle_nm = demanded(demand, start_s + 0.5 * h)
        derivative(state, demanded(demand, start_s), mu, car, rates[0])
        derivative(state + 0.5 * h * rates[0], middle_nm, mu, car, rates[1])
        derivative(state + 0.5 * h * rates[1], middle_nm, mu, car, rates[2])
        derivative(state + h * rates[2], demanded(demand, start_s + h), mu, car, rates[3])
        state += h / 6.0 * (rates[0] + 2.0 * rates[1] + 2.0 * rates[2] + rates[3])


class QuarterCarPlant:
    """State of a quarter car on a road."""

    def __init__(self, car: QuarterCar, road: NDArray[np.float64], speed_mps: float) -> None:
        self._car = record(car)
        self._road = road
        omega = speed_mps / car.wheel_radius_m
        self._state = np.array([speed_mps, omega, omega, 0.0])

    def advance(self, demand: Demand, duration_s: float) -> None:
        """Integrate over ``duration_s``."""
        advance(self._state, demand, self._car, self._road, duration_s)

    def truth(self, time_s: float, demand: Demand) -> Truth:
        """Every state now; what a quarter car has not (shaft, pitch, own rear load) is zero."""
        return _truth(time_s, self._state, demand, self._car, self._road)


@compiled
def _truth(
    time_s: float,
    state: NDArray[np.float64],
    demand: Demand,
    car: QuarterCar,
    road: NDArray[np.float64],
) -> Truth:
    patch = road[patch_at(road, state[POSITION])]
    mu = (patch[MU_LEFT], patch[MU_RIGHT])
    speed, left, right = state[SPEED], state[WHEEL_LEFT], state[WHEEL_RIGHT]
    radius, gear = car.wheel_radius_m, car.gear_ratio
    kappa = (slip(car, left, speed), slip(car, right, speed), 0.0, 0.0)
    force = (tyre_force(car, kappa[0], mu[0]), tyre_force(car, kappa[1], mu[1]), 0.0, 0.0)
    torque = demanded(demand, 0.0)
    load_n = car.mass_kg * GRAVITY_MPS2 / 4.0
    return Truth(
        time_s,
        state[POSITION],
        speed,
        2.0 / car.mass_kg * (force[0] + force[1]),
        0.0,
        0.0,
        0.0,
        demand.request_nm,
        (demand.limit_left_nm, demand.limit_right_nm),
        torque,
        (gear * left, gear * right),
        (0.0, 0.0),
        (gear * torque[0], gear * torque[1]),
        (left, right, speed / radius, speed / radius),
        (left * radius - speed, right * radius - speed, 0.0, 0.0),
        kappa,
        kappa,
        force,
        (load_n, load_n, load_n, load_n),
        (mu[0], mu[1], mu[0], mu[1]),
    )
