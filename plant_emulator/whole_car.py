"""The whole car: body, four tyres and two drivelines as one set of differential equations."""

from __future__ import annotations

import math

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
from plant_emulator.road import Site
from plant_emulator.truth import (
    ACCEL,
    BRAKE_TORQUE,
    FORCE,
    LOAD,
    MU,
    SHAFT_TORQUE,
    TYRE_SLIP,
    Row,
)
from plant_emulator.truth import MOTOR_TORQUE as MOTOR_NM
from plant_emulator.tyre import (
    Tyre,
    low_speed_slip,
    modified_slip,
    relaxation_length,
    rolling_resistance,
    rolling_speed,
    slip_stiffness,
    tyre_force,
)
from tcs_hil.signals import Pair

Array = NDArray[np.float64]

SPEED, POSITION, HEAVE, HEAVE_RATE, PITCH, PITCH_RATE = range(6)
WHEEL, ANGLE, TRANSIENT_SLIP, HELD_AT = 6, 10, 14, 18  # four each
MOTOR_TORQUE, MOTOR_SPEED, TWIST = 22, 24, 26  # two each
SIZE = 28


class WholeCar(Table, frozen=True):
    """Every parameter of the car."""

    body: Body = Body()
    tyre: Tyre = Tyre()
    driveline: Driveline = Driveline()


@compiled
def derivative(
    state: Array, asked_nm: Pair, site: Site, car: WholeCar, row: Row, rate: Array
) -> None:
    """Write what acts now into ``row`` of the truth and the derivative of ``state`` into ``rate``.

    Order matters: each part reads what those before it have written.
    """
    axle_n = _suspension(state, car.body)
    load_n = wheel_loads(car.body, axle_n[0], axle_n[1], site.grade_cos)
    force_n = -drag(car.body, state[SPEED])
    for wheel in range(4):
        row[LOAD + wheel] = load_n[0] if wheel < 2 else load_n[1]
        _touch(state, site, car, wheel, row, rate)
        force_n += row[FORCE + wheel]
    for side in range(2):
        _drive(state, car, side, asked_nm[side], row, rate)
    row[ACCEL] = force_n / car.body.mass_kg - GRAVITY_MPS2 * site.grade_sin
    rate[SPEED], rate[POSITION] = row[ACCEL], state[SPEED]
    if car.body.load_transfer:
        _bounce(state, site, car, axle_n, row, rate)


@compiled
def _suspension(state: Array, body: Body) -> Pair:
    if not body.load_transfer:
        return 0.0, 0.0
    heave, pitch = (state[HEAVE], state[HEAVE_RATE]), (state[PITCH], state[PITCH_RATE])
    return suspension(body, sprung(body), heave, pitch)


@compiled
def _touch(state: Array, site: Site, car: WholeCar, wheel: int, row: Row, rate: Array) -> None:
    """What road and brake do to one wheel."""
    radius, omega, load_n = car.body.wheel_radius_m, state[WHEEL + wheel], row[LOAD + wheel]
    force_n = _grip(state, site, car, wheel, row, rate)
    brake_nm = 0.0
    if not math.isnan(state[HELD_AT + wheel]):
        brake_nm = hold_torque(car.body, state[ANGLE + wheel] - state[HELD_AT + wheel], omega)
    resistance_nm = rolling_resistance(car.tyre, omega * radius, load_n, radius)
    row[FORCE + wheel], row[BRAKE_TORQUE + wheel] = force_n, brake_nm
    torque_nm = brake_nm - resistance_nm - force_n * radius
    rate[WHEEL + wheel] = torque_nm / car.body.wheel_inertia_kgm2
    rate[ANGLE + wheel] = omega


@compiled
def _grip(state: Array, site: Site, car: WholeCar, wheel: int, row: Row, rate: Array) -> float:
    """Force of one tyre, N, and how its slip follows."""
    tyre, speed, rim_mps = car.tyre, state[SPEED], state[WHEEL + wheel] * car.body.wheel_radius_m
    load_n, mu = row[LOAD + wheel], row[MU + wheel]
    peak_only = site.front_peak_only if wheel < 2 else site.rear_peak_only
    if tyre.relaxation_m == 0.0:
        row[TYRE_SLIP + wheel] = modified_slip(rim_mps, speed)
        return tyre_force(tyre, row[TYRE_SLIP + wheel], load_n, mu, peak_only)
    stiffness_n = max(slip_stiffness(tyre, load_n) * (1.0 if peak_only else mu), 1.0)
    slip_mps, rolling_mps = rim_mps - speed, rolling_speed(rim_mps, speed)
    kappa = state[TRANSIENT_SLIP + wheel]
    damping = low_speed_slip(tyre, slip_mps, rolling_mps, stiffness_n)
    force_n = tyre_force(tyre, kappa + damping, load_n, mu, peak_only)
    length_m = relaxation_length(tyre, kappa + damping, force_n, stiffness_n)
    rate[TRANSIENT_SLIP + wheel] = (slip_mps - rolling_mps * kappa) / length_m
    row[TYRE_SLIP + wheel] = kappa + damping
    return force_n


@compiled
def _drive(state: Array, car: WholeCar, side: int, asked_nm: float, row: Row, rate: Array) -> None:
    """Motor and half-shaft of one side, and what they do to its wheel."""
    line, motor, gear = car.driveline, state[MOTOR_SPEED + side], car.driveline.gear_ratio
    wheel_kgm2 = car.body.wheel_inertia_kgm2
    aim_nm = attainable(line, asked_nm, motor)
    torque_nm = state[MOTOR_TORQUE + side] if line.motor_lag_s > 0.0 else aim_nm
    rate[TWIST + side] = motor / gear - state[WHEEL + side]
    if line.shaft_stiffness_nmprad > 0.0:
        shaft_nm = shaft_torque(line, state[TWIST + side], rate[TWIST + side])
    else:  # a rigid shaft carries what both inertias together need
        motor_kgm2 = gear * gear * line.motor_inertia_kgm2
        outer_nm = wheel_kgm2 * rate[WHEEL + side]
        omega_rate = (gear * torque_nm + outer_nm) / (wheel_kgm2 + motor_kgm2)
        shaft_nm = gear * torque_nm - motor_kgm2 * omega_rate
    rate[WHEEL + side] += shaft_nm / wheel_kgm2
    rate[MOTOR_SPEED + side] = (torque_nm - shaft_nm / gear) / line.motor_inertia_kgm2
    if line.motor_lag_s > 0.0:
        rate[MOTOR_TORQUE + side] = torque_rate(line, aim_nm, torque_nm)
    row[MOTOR_NM + side], row[SHAFT_TORQUE + side] = torque_nm, shaft_nm


@compiled
def _bounce(state: Array, site: Site, car: WholeCar, axle_n: Pair, row: Row, rate: Array) -> None:
    """Heave and pitch of the sprung mass."""
    body, part = car.body, sprung(car.body)
    push_n = part.mass_kg * (row[ACCEL] + GRAVITY_MPS2 * site.grade_sin) + drag(body, state[SPEED])
    reaction_nm = row[SHAFT_TORQUE] + row[SHAFT_TORQUE + 1]
    for wheel in range(4):
        reaction_nm += row[BRAKE_TORQUE + wheel]
    moment_nm = pitch_moment(part, push_n, reaction_nm)
    moment_nm += part.behind_front_axle_m * axle_n[0] - part.before_rear_axle_m * axle_n[1]
    rate[HEAVE], rate[PITCH] = state[HEAVE_RATE], state[PITCH_RATE]
    rate[HEAVE_RATE] = (axle_n[0] + axle_n[1]) / part.mass_kg
    rate[PITCH_RATE] = moment_nm / body.pitch_inertia_kgm2
