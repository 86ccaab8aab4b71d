"""Runs that excite a fleet around its operating point, and the transitions in them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from tcs_hil.model.fleet import BODY, MOTOR, TORQUE, WHEEL, Fleet
from tcs_hil.model.observables import Observable, Sample, lift
from tcs_hil.model.ranges import Range, check_rising
from tcs_hil.model.vehicle import Positive, Vehicle

FloatArray = NDArray[np.float64]
NonNegative = Annotated[float, msgspec.Meta(ge=0.0)]
Count = Annotated[int, msgspec.Meta(ge=1)]


class ExcitationSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Held random torque on top of a loose slip loop that keeps the wheel where it is driven.

    Without the loop half of the wheels would spin away from the operating point
    within a run: beyond the peak of the tyre the slip integrates the torque.

    The noise on the motor's signals, seen from the wheel, keeps the regression
    from leaning on differences that a real sensor drowns; six times a real
    sensor's cuts the chatter of the torque by a third and costs little else.
    """

    runs: Count = 300
    samples: Annotated[int, msgspec.Meta(ge=10)] = 250
    aim_slip_ratio: Range = (0.03, 0.2)
    initial_slip_ratio: Range = (0.0, 0.15)
    torque_nm: Range = (-60.0, 60.0)
    hold_periods: tuple[int, int] = (1, 20)
    loop_gain_nm: Positive = 14.0  # per unit slip at standstill ...
    loop_gain_nm_per_mps: Positive = 42.0  # ... and its slope, up to the ceiling
    loop_speed_ceiling_mps: Positive = 15.0
    motor_speed_noise_radps: NonNegative = 0.1
    motor_torque_noise_nm: NonNegative = 0.3

    def __post_init__(self) -> None:
        check_rising(self)


class Runs(NamedTuple):
    """Bus signals of n runs over T + 1 instants, and the T commands between them."""

    sample: Sample  # of (T + 1, n)
    speed_mps: FloatArray  # (T + 1, n)
    command_nm: FloatArray  # (T, n)


class Transitions(NamedTuple):
    """Pairs of lifted states one period apart."""

    z: FloatArray  # (n, NZ)
    u: FloatArray  # (n,), Nm
    z_next: FloatArray  # (n, NZ)
    speed_mps: FloatArray  # (n,)

    def where(self, rows: NDArray[np.bool_]) -> Transitions:
        """Some of the transitions."""
        return Transitions(*(column[rows] for column in self))


def excite(
    fleet: Fleet,
    settings: ExcitationSettings,
    speed_mps: FloatArray,
    period_s: float,
    rng: np.random.Generator,
) -> Runs:
    """Drive every car of the fleet once from its start speed (n,)."""
    cars = speed_mps.size
    aim = rng.uniform(*settings.aim_slip_ratio, cars)
    x = fleet.at_slip(speed_mps, rng.uniform(*settings.initial_slip_ratio, cars))
    gain = settings.loop_gain_nm + settings.loop_gain_nm_per_mps * np.minimum(
        speed_mps, settings.loop_speed_ceiling_mps
    )
    base_nm = fleet.holding_torque_nm(aim)
    before_nm = x[TORQUE]
    states, commands = [x], []
    for excitation_nm in _held(settings, cars, rng):
        slip = 1.0 - x[BODY] / (np.maximum(x[WHEEL], 1e-3) * fleet.vehicle.wheel_radius_m)
        command_nm = base_nm + gain * (aim - slip) + excitation_nm
        command_nm = np.clip(command_nm, 0.0, fleet.vehicle.motor_torque_max_nm)
        x = fleet.step(x, before_nm, command_nm, period_s)
        before_nm = command_nm
        states.append(x)
        commands.append(command_nm)
    runs = _runs(np.stack(states, axis=1), np.stack(commands), fleet.vehicle)
    return runs._replace(sample=_noisy(runs.sample, settings, rng))


def log_uniform(bounds: Range, size: int, rng: np.random.Generator) -> FloatArray:
    """Start speeds (size,) whose logarithm is uniform: every speed matters by its ratio."""
    low, high = np.log(bounds)
    return np.exp(rng.uniform(low, high, size))


def transitions(runs: Runs, vehicle: Vehicle) -> Transitions:
    """Every transition of the runs; the first period only fills the memory of the lifting."""
    z = lift(
        Sample(*(column[1:] for column in runs.sample)),
        Sample(*(column[:-1] for column in runs.sample)),
        vehicle,
    )  # (T, n, NZ)
    nz = len(Observable)
    return Transitions(
        z[:-1].reshape(-1, nz),
        runs.command_nm[1:].reshape(-1),
        z[1:].reshape(-1, nz),
        runs.speed_mps[1:-1].reshape(-1),
    )


def _held(
    settings: ExcitationSettings, cars: int, rng: np.random.Generator
) -> Iterator[FloatArray]:
    """Torque (cars,) of each sample, redrawn after a random number of periods."""
    torque, left = np.zeros(cars), np.zeros(cars, dtype=int)
    for _ in range(settings.samples):
        due = left <= 0
        torque = np.where(due, rng.uniform(*settings.torque_nm, cars), torque)
        left = np.where(due, rng.integers(*settings.hold_periods, cars, endpoint=True), left) - 1
        yield torque


def _noisy(sample: Sample, settings: ExcitationSettings, rng: np.random.Generator) -> Sample:
    shape = sample.motor_torque_nm.shape
    speed_noise = settings.motor_speed_noise_radps * rng.standard_normal(shape)
    torque_noise = settings.motor_torque_noise_nm * rng.standard_normal(shape)
    return sample._replace(
        motor_speed_radps=sample.motor_speed_radps + speed_noise,
        motor_torque_nm=sample.motor_torque_nm + torque_noise,
    )


def _runs(states: FloatArray, commands_nm: FloatArray, vehicle: Vehicle) -> Runs:
    speed, omega = states[BODY], states[WHEEL]
    slip_speed = omega * vehicle.wheel_radius_m - speed
    return Runs(
        Sample(slip_speed, omega, states[MOTOR], states[TORQUE]),
        speed,
        commands_nm,
    )
