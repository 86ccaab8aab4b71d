"""The whole car in time: integration, teeth passing their sensors, and the parking hold."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plant_emulator import truth
from plant_emulator.body import GRAVITY_MPS2
from plant_emulator.compiled import compiled, opened, records
from plant_emulator.encoder import Encoder, WheelMotion, make_encoder, pass_edges
from plant_emulator.inverter import Demand, Lines, demanded
from plant_emulator.road import site_at, time_to_edge
from plant_emulator.runge_kutta import STAGES, Work, blend, conclude, steps_for, work_for
from plant_emulator.sensors import IDEAL, Sensors
from plant_emulator.truth import MU, ROW_SIZE, Row
from plant_emulator.tyre import modified_slip
from plant_emulator.whole_car import (
    ANGLE,
    HEAVE,
    HEAVE_RATE,
    HELD_AT,
    MOTOR_SPEED,
    PITCH,
    PITCH_RATE,
    POSITION,
    SIZE,
    SPEED,
    TRANSIENT_SLIP,
    TWIST,
    WHEEL,
    Array,
    WholeCar,
    derivative,
)
from tcs_hil.errors import ConfigError
from tcs_hil.signals import Pair

STANDSTILL_MPS = 0.05
SETTLING_S = 3.0


class Moving(NamedTuple):
    """A car on its way: what it is, what changes while it drives and where that is computed.

    One record, because each array that Python hands over costs as much as a step.
    """

    car: WholeCar
    state: Array  # (SIZE,)
    numbers: NDArray[np.int64]  # (4, 3), the encoder's
    marks: Array  # (4, 3), the encoder's
    work: Work


@compiled
def advance(
    moving: Sequence[Moving],  # one
    edges: Array,  # (4, edges of a turn), the encoder's
    lines: Lines,
    road: Array,  # (patches, 5)
    start_s: float,
    duration_s: float,
) -> None:
    """Integrate with the classic Runge-Kutta method, in steps of at most 0.1 ms.

    A step ends where an axle comes onto another patch of the road.
    """
    demand = Demand(*lines)
    _hold_or_release(moving[0], demand, road)
    state, wheelbase_m = moving[0].state, moving[0].car.body.wheelbase_m
    steps = steps_for(duration_s)
    longest_s = duration_s / steps
    for step in range(steps):
        left_s = longest_s
        while left_s > 0.0:
            h = min(left_s, time_to_edge(road, state[POSITION], state[SPEED], wheelbase_m))
            piece = (step * longest_s + longest_s - left_s, h)
            _step(moving[0], demand, road, piece)
            if edges.shape[1] > 0:
                _watch_teeth(moving[0], edges, start_s, piece)
            left_s -= h


@compiled
def _hold_or_release(moving: Moving, demand: Demand, road: Array) -> None:
    """Brake at standstill when nothing is asked of the motors; let go when they carry the car.

    What counts is what they are asked for after their limits: a request that a limit
    takes away opens no brake.
    """
    state, (left_nm, right_nm) = moving.state, demanded(demand, 0.0)
    asked_nm, held = left_nm + right_nm, not math.isnan(state[HELD_AT])
    if not held and asked_nm <= 0.0 and _stands(state, moving.car.body.wheel_radius_m):
        for wheel in range(4):  # a loop: slices take the compiler seconds
            state[HELD_AT + wheel] = state[ANGLE + wheel]
    elif held and asked_nm > _slope_torque(moving, road):
        for wheel in range(4):
            state[HELD_AT + wheel] = math.nan


@compiled
def _stands(state: Array, radius_m: float) -> bool:
    fastest_mps = abs(state[SPEED])
    for wheel in range(4):
        fastest_mps = max(fastest_mps, abs(state[WHEEL + wheel] * radius_m))
    return bool(fastest_mps < STANDSTILL_MPS)


@compiled
def _slope_torque(moving: Moving, road: Array) -> float:
    """Torque of both motors together that balances the grade, Nm."""
    body = moving.car.body
    site = site_at(road, moving.state[POSITION], body.wheelbase_m, moving.work.row)
    pull_n = body.mass_kg * GRAVITY_MPS2 * max(site.grade_sin, 0.0)
    return pull_n * body.wheel_radius_m / moving.car.driveline.gear_ratio


@compiled
def _step(moving: Moving, demand: Demand, road: Array, piece: Pair) -> None:
    """One step on the road under the car; ``piece``: when on the demand's line, how long (s)."""
    elapsed_s, h = piece
    car, state, work = moving.car, moving.state, moving.work
    site = site_at(road, state[POSITION], car.body.wheelbase_m, work.row)
    for stage in range(4):
        offset_s = STAGES[stage] * h
        blend(work.trial, state, offset_s, work.rates[stage - 1])
        asked_nm = demanded(demand, elapsed_s + offset_s)
        derivative(work.trial, asked_nm, site, car, work.row, work.rates[stage])
    blend(work.trial, state, 0.0, work.rates[0])  # where the step began, for the teeth
    conclude(state, h, work.rates)


@compiled
def _watch_teeth(moving: Moving, edges: Array, start_s: float, piece: Pair) -> None:
    """Stamp the edges that passed in the step just taken."""
    elapsed_s, h = piece
    encoder = Encoder(edges, moving.numbers, moving.marks)
    before, after = moving.work.trial, moving.state
    for wheel in range(4):
        angles = (before[ANGLE + wheel], after[ANGLE + wheel])
        pass_edges(encoder, wheel, angles[0], angles[1], start_s + elapsed_s, h)


@compiled
def _observe(moving: Sequence[Moving], lines: Lines, road: Array, row: Row) -> None:
    car, state = moving[0].car, moving[0].state
    site = site_at(road, state[POSITION], car.body.wheelbase_m, row)
    derivative(state, demanded(Demand(*lines), 0.0), site, car, row, moving[0].work.trial)
    row[truth.DISTANCE], row[truth.BODY_SPEED] = state[POSITION], state[SPEED]
    row[truth.SPECIFIC_FORCE] = row[truth.ACCEL] + GRAVITY_MPS2 * (site.grade_sin + state[PITCH])
    row[truth.PITCH], row[truth.HEAVE] = state[PITCH], state[HEAVE]
    row[truth.PITCH_RATE], row[truth.HEAVE_RATE] = state[PITCH_RATE], state[HEAVE_RATE]
    row[truth.HELD] = 0.0 if math.isnan(state[HELD_AT]) else 1.0
    row[truth.GRADE] = site.grade_sin / site.grade_cos
    for side in range(2):
        row[truth.MOTOR_SPEED + side] = state[MOTOR_SPEED + side]
        row[truth.SHAFT_TWIST + side] = state[TWIST + side]
    for wheel in range(4):
        rim = state[WHEEL + wheel] * car.body.wheel_radius_m
        row[truth.WHEEL_SPEED + wheel] = state[WHEEL + wheel]
        row[truth.SLIP_SPEED + wheel] = rim - state[SPEED]
        row[truth.SLIP_RATIO + wheel] = modified_slip(rim, state[SPEED])
        row[truth.WHEEL_ANGLE + wheel] = state[ANGLE + wheel]
        row[truth.TRANSIENT_SLIP + wheel] = state[TRANSIENT_SLIP + wheel]
        if row[truth.HELD] > 0.0:
            row[truth.HOLD_TWIST + wheel] = state[ANGLE + wheel] - state[HELD_AT + wheel]


class WholeCarPlant:
    """State of a whole car on a road."""

    def __init__(
        self, car: WholeCar, road: NDArray[np.float64], speed_mps: float, sensors: Sensors
    ) -> None:
        self._car = car
        self._road = road
        self._state = _rolling(car, road, speed_mps)
        self._fit(IDEAL)
        if speed_mps == 0.0:
            self._settle()
        self._fit(sensors)

    def _fit(self, sensors: Sensors) -> None:
        """Put toothed rings on the wheels as they stand."""
        rng = np.random.default_rng(sensors.seed)
        fitted = make_encoder(sensors.teeth, sensors.pitch_error_ratio, self.wheels, rng)
        still = Moving(self._car, self._state, fitted.numbers, fitted.marks, work_for(SIZE))
        self._moving = records(still)
        moving = opened(self._moving)
        self._state = moving.state
        self.encoder = Encoder(fitted.edges, moving.numbers, moving.marks)

    @property
    def wheels(self) -> WheelMotion:
        """Angle and speed of the wheels now."""
        return WheelMotion(
            self._state[ANGLE : ANGLE + 4].copy(), self._state[WHEEL : WHEEL + 4].copy()
        )

    def advance(self, demand: Demand, time_s: float, duration_s: float) -> None:
        """Integrate over ``duration_s``.

        Raises:
            ConfigError: the parameters are too stiff for the integration step.
        """
        lines = tuple(demand)
        advance(self._moving, self.encoder.edges, lines, self._road, time_s, duration_s)
        if not math.isfinite(self._state[SPEED]):
            raise ConfigError(
                f"the plant diverged at {time_s:.3f} s: "
                "parameters in [vehicle] are too stiff for steps of 0.1 ms"
            )

    def observe(self, demand: Demand, row: Row) -> None:
        """Fill in every state, force and load now."""
        _observe(self._moving, tuple(demand), self._road, row)

    def _settle(self) -> None:
        """Let a car that starts from rest sink into its springs, held by its brakes."""
        still = Demand((0.0, 0.0), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0))
        self.advance(still, 0.0, SETTLING_S)
        self._state[POSITION] = 0.0


def _rolling(car: WholeCar, road: NDArray[np.float64], speed_mps: float) -> Array:
    """Every wheel rolling freely, springs at rest, brakes open.

    Free rolling takes the little braking slip whose force turns the wheel against
    its rolling resistance; without it the wheels would start with a jerk.
    """
    state, row = np.zeros(SIZE), np.zeros(ROW_SIZE)
    site_at(road, 0.0, car.body.wheelbase_m, row)
    slip = np.zeros(4)
    if car.tyre.relaxation_m > 0.0 and speed_mps > 0.0:
        slip[:] = -car.tyre.qsy1 / (car.tyre.pkx1 * row[MU : MU + 4])
    omega = (1.0 + slip) * speed_mps / car.body.wheel_radius_m
    state[SPEED] = speed_mps
    state[TRANSIENT_SLIP : TRANSIENT_SLIP + 4] = slip
    state[WHEEL : WHEEL + 4] = omega
    state[MOTOR_SPEED : MOTOR_SPEED + 2] = omega[:2] * car.driveline.gear_ratio
    state[HELD_AT : HELD_AT + 4] = np.nan
    return state
