"""The whole car: body, four tyres and two drivelines as one set of differential equations."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plant_emulator.body import (
    GRAVITY_MPS2,
    Body,
    drag,
    hold_torque,
    pitch_moment,
    sprung,
    suspension,
    wheel_loads,
)
from plant_emulator.bounds import Table
from plant_emulator.compiled import compiled
from plant_emulator.driveline import Driveline, attainable, shaft_torque, torque_rate
from plant_emulator.road import GRADE, MU_LEFT, MU_RIGHT, PEAK_ONLY, patch_at
from plant_emulator.tyre import (
    Tyre,
    deflection_rate,
    modified_slip,
    rolling_resistance,
    slip_stiffness,
    transient_slip,
    tyre_force,
)
from tcs_hil.signals import FourWheels, Pair

State = NDArray[np.float64]  # (SIZE,)

SPEED, POSITION, HEAVE, HEAVE_RATE, PITCH, PITCH_RATE = range(6)
WHEEL, ANGLE, DEFLECTION, HELD_AT = 6, 10, 14, 18  # four each
MOTOR_TORQUE, MOTOR_SPEED, TWIST = 22, 24, 26  # two each
SIZE = 28


class WholeCar(Table, frozen=True):
    """Every parameter of the car."""

    body: Body = Body()
    tyre: Tyre = Tyre()
    driveline: Driveline = Driveline()


class Site(NamedTuple):
    """The road under the car."""

    mu: FourWheels
    peak_only: tuple[bool, bool]  # front, rear
    grade_sin: float
    grade_cos: float


class Corner(NamedTuple):
    """What acts on one wheel from outside its half-shaft."""

    slip_ratio: float
    tyre_n: float
    brake_nm: float
    outer_nm: float  # all but the shaft, forwards positive


class Forces(NamedTuple):
    """Everything that acts, at one instant."""

    load_n: Pair  # one front, one rear wheel
    corners: tuple[Corner, Corner, Corner, Corner]
    motor_nm: Pair
    aim_nm: Pair
    shaft_nm: Pair
    axle_n: Pair  # suspension, beyond the static force
    accel_mps2: float


@compiled
def site_at(road: NDArray[np.float64], position_m: float, wheelbase_m: float) -> Site:
    """Friction under each wheel (rear ones a wheelbase behind) and the mean grade."""
    front = road[patch_at(road, position_m)]
    rear = road[patch_at(road, position_m - wheelbase_m)]
    angle = math.atan(0.5 * (front[GRADE] + rear[GRADE]))
    return Site(
        (front[MU_LEFT], front[MU_RIGHT], rear[MU_LEFT], rear[MU_RIGHT]),
        (front[PEAK_ONLY] > 0.0, rear[PEAK_ONLY] > 0.0),
        math.sin(angle),
        math.cos(angle),
    )


@compiled
def _corner(state: State, car: WholeCar, site: Site, wheel: int, load_n: float) -> Corner:
    speed, omega = state[SPEED], state[WHEEL + wheel]
    rim, mu, peak_only = omega * car.body.wheel_radius_m, site.mu[wheel], site.peak_only[wheel // 2]
    if car.tyre.relaxation_m > 0.0:
        stiffness_n = slip_stiffness(car.tyre, load_n) * (1.0 if peak_only else mu)
        kappa = transient_slip(car.tyre, state[DEFLECTION + wheel], rim, speed, stiffness_n)
    else:
        kappa = modified_slip(rim, speed)
    force = tyre_force(car.tyre, kappa, load_n, mu, peak_only)
    brake = 0.0
    if not math.isnan(state[HELD_AT + wheel]):
        brake = hold_torque(car.body, state[ANGLE + wheel] - state[HELD_AT + wheel], omega)
    resistance = rolling_resistance(car.tyre, rim, load_n, car.body.wheel_radius_m)
    return Corner(kappa, force, brake, brake - force * car.body.wheel_radius_m - resistance)


@compiled
def _motor(state: State, line: Driveline, side: int, asked_nm: float) -> Pair:
    """Air-gap torque and the torque it heads for."""
    aim = attainable(line, asked_nm, state[MOTOR_SPEED + side])
    return (state[MOTOR_TORQUE + side] if line.motor_lag_s > 0.0 else aim), aim


@compiled
def _shaft(state: State, car: WholeCar, side: int, motor_nm: float, outer_nm: float) -> float:
    """Torque a half-shaft puts on its wheel; a rigid one as much as both inertias together need."""
    line, inertia = car.driveline, car.body.wheel_inertia_kgm2
    if line.shaft_stiffness_nmprad > 0.0:
        slow = state[MOTOR_SPEED + side] / line.gear_ratio - state[WHEEL + side]
        return shaft_torque(line, state[TWIST + side], slow)
    reflected = line.gear_ratio * line.gear_ratio * line.motor_inertia_kgm2
    omega_rate = (line.gear_ratio * motor_nm + outer_nm) / (inertia + reflected)
    return line.gear_ratio * motor_nm - reflected * omega_rate


@compiled
def forces(state: State, asked_nm: Pair, site: Site, car: WholeCar) -> Forces:
    """Everything that acts on the car in ``state``."""
    body = car.body
    axle_n = (0.0, 0.0)
    if body.load_transfer:
        heave, pitch = (state[HEAVE], state[HEAVE_RATE]), (state[PITCH], state[PITCH_RATE])
        axle_n = suspension(body, sprung(body), heave, pitch)
    load_n = wheel_loads(body, axle_n, site.grade_cos)
    left, right = _corner(state, car, site, 0, load_n[0]), _corner(state, car, site, 1, load_n[0])
    corners = (
        left,
        right,
        _corner(state, car, site, 2, load_n[1]),
        _corner(state, car, site, 3, load_n[1]),
    )
    left_nm, left_aim = _motor(state, car.driveline, 0, asked_nm[0])
    right_nm, right_aim = _motor(state, car.driveline, 1, asked_nm[1])
    shaft_nm = (
        _shaft(state, car, 0, left_nm, left.outer_nm),
        _shaft(state, car, 1, right_nm, right.outer_nm),
    )
    push_n = left.tyre_n + right.tyre_n + corners[2].tyre_n + corners[3].tyre_n
    accel = (push_n - drag(body, state[SPEED])) / body.mass_kg - GRAVITY_MPS2 * site.grade_sin
    return Forces(
        load_n, corners, (left_nm, right_nm), (left_aim, right_aim), shaft_nm, axle_n, accel
    )


@compiled
def derivative(state: State, asked_nm: Pair, site: Site, car: WholeCar, rate: State) -> None:
    """Write the time derivative of ``state`` into ``rate``."""
    acting = forces(state, asked_nm, site, car)
    rate[:] = 0.0
    rate[SPEED] = acting.accel_mps2
    rate[POSITION] = state[SPEED]
    if car.body.load_transfer:
        _body_rates(state, acting, site, car.body, rate)
    _wheel_rates(state, acting, car, rate)
    for side in range(2):
        line, shaft_nm = car.driveline, acting.shaft_nm[side]
        if line.motor_lag_s > 0.0:
            rate[MOTOR_TORQUE + side] = torque_rate(line, acting.aim_nm[side], acting.motor_nm[side])
        rate[MOTOR_SPEED + side] = (
            acting.motor_nm[side] - shaft_nm / line.gear_ratio
        ) / line.motor_inertia_kgm2
        rate[TWIST + side] = state[MOTOR_SPEED + side] / line.gear_ratio - state[WHEEL + side]


@compiled
def _wheel_rates(state: State, acting: Forces, car: WholeCar, rate: State) -> None:
    radius = car.body.wheel_radius_m
    for wheel in range(4):
        omega = state[WHEEL + wheel]
        shaft_nm = acting.shaft_nm[wheel] if wheel < 2 else 0.0
        rate[WHEEL + wheel] = (
            shaft_nm + acting.corners[wheel].outer_nm
        ) / car.body.wheel_inertia_kgm2
        rate[ANGLE + wheel] = omega
        if car.tyre.relaxation_m > 0.0:
            rate[DEFLECTION + wheel] = deflection_rate(
                car.tyre, state[DEFLECTION + wheel], omega * radius, state[SPEED]
            )


@compiled
def _body_rates(state: State, acting: Forces, site: Site, body: Body, rate: State) -> None:
    part = sprung(body)
    front_n, rear_n = acting.axle_n
    push_n = part.mass_kg * (acting.accel_mps2 + GRAVITY_MPS2 * site.grade_sin)
    push_n += drag(body, state[SPEED])
    reaction_nm = acting.shaft_nm[0] + acting.shaft_nm[1]
    for corner in acting.corners:
        reaction_nm += corner.brake_nm
    moment_nm = pitch_moment(part, push_n, reaction_nm)
    moment_nm += part.behind_front_axle_m * front_n - part.before_rear_axle_m * rear_n
    rate[HEAVE] = state[HEAVE_RATE]
    rate[HEAVE_RATE] = (front_n + rear_n) / part.mass_kg
    rate[PITCH] = state[PITCH_RATE]
    rate[PITCH_RATE] = moment_nm / body.pitch_inertia_kgm2
