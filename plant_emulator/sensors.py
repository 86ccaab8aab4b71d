"""The sensors: what the car's electronics read of the truth."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

import numpy as np
from msgspec import Meta

from plant_emulator.bounds import TEETH_MAX, Finite, NonNegative, Positive, Seed, Table
from plant_emulator.encoder import (
    Encoder,
    SpeedUnit,
    WheelMotion,
    make_speed_unit,
    sample_speeds,
)
from plant_emulator.truth import (
    MOTOR_SPEED,
    MOTOR_TORQUE,
    REQUEST,
    SPECIFIC_FORCE,
    TIME,
    WHEEL_SPEED,
    Row,
)
from tcs_hil.canbus.vehicle_node import VehicleSignals
from tcs_hil.signals import FourWheels

Teeth = Annotated[int, Meta(ge=0, le=TEETH_MAX)]


class Sensors(Table, frozen=True):
    """Quality of every sensor.

    ``teeth`` 0 is an ideal wheel-speed sensor; ``pitch_error_ratio`` is the most an
    edge is off, in pitches.  Below ``speed_min_radps`` a sensor reads zero and is
    invalid (a passive one; 0 for an active one); after ``dropout_s`` without an
    edge it reads zero.  Noise figures are standard deviations.
    """

    teeth: Teeth = 48
    pitch_error_ratio: Annotated[float, Meta(ge=0.0, le=0.2)] = 0.01
    dropout_s: Positive = 0.25
    speed_min_radps: NonNegative = 0.0
    motor_speed_noise_radps: NonNegative = 0.05
    motor_torque_noise_nm: NonNegative = 0.25
    accelerometer: bool = True
    accel_bias_mps2: Finite = 0.05
    accel_noise_mps2: NonNegative = 0.03
    seed: Seed = 1


IDEAL = Sensors(
    teeth=0,
    pitch_error_ratio=0.0,
    motor_speed_noise_radps=0.0,
    motor_torque_noise_nm=0.0,
    accel_bias_mps2=0.0,
    accel_noise_mps2=0.0,
)
"""Sensors that tell the truth."""


class SensorSet:
    """Samples the sensors; each sample draws noise and counts edges, so sample once per instant."""

    def __init__(
        self,
        sensors: Sensors,
        rng: np.random.Generator,
        encoder: Encoder | None = None,
        rolling: WheelMotion | None = None,
    ) -> None:
        self._sensors = sensors
        self._noise = _draws(rng)
        self._encoder = encoder
        self._unit: SpeedUnit | None = None
        if sensors.teeth and encoder is not None and rolling is not None:
            self._unit = make_speed_unit(encoder, rolling, sensors.dropout_s)

    def sample(self, row: Row) -> VehicleSignals:
        """Read every sensor at the instant of a row of the truth."""
        sensors, noise, values = self._sensors, next(self._noise), row.tolist()
        motor_left, motor_right = values[MOTOR_SPEED : MOTOR_SPEED + 2]
        torque_left, torque_right = values[MOTOR_TORQUE : MOTOR_TORQUE + 2]
        request_nm = values[REQUEST]
        speed_noise, torque_noise = sensors.motor_speed_noise_radps, sensors.motor_torque_noise_nm
        speeds, valid = self._wheels(values)
        return VehicleSignals(
            wheel_speed_radps=speeds,
            wheel_speed_valid=valid,
            motor_speed_radps=(
                motor_left + speed_noise * noise[0],
                motor_right + speed_noise * noise[1],
            ),
            motor_torque_nm=(
                torque_left + torque_noise * noise[2],
                torque_right + torque_noise * noise[3],
            ),
            driver_torque_nm=(request_nm, request_nm),
            accel_x_mps2=self._accel(values[SPECIFIC_FORCE], noise[4]),
        )

    def _wheels(self, values: list[float]) -> tuple[FourWheels, tuple[bool, bool, bool, bool]]:
        if self._unit is None or self._encoder is None:
            speeds = [abs(speed) for speed in values[WHEEL_SPEED : WHEEL_SPEED + 4]]
        else:
            sample_speeds(self._unit, self._encoder, values[TIME])
            speeds = self._unit.speed_radps.tolist()
        least = self._sensors.speed_min_radps
        fl, fr, rl, rr = (speed if speed >= least else 0.0 for speed in speeds)
        return (fl, fr, rl, rr), (fl >= least, fr >= least, rl >= least, rr >= least)

    def _accel(self, specific_force_mps2: float, noise: float) -> float | None:
        sensors = self._sensors
        if not sensors.accelerometer:
            return None
        return specific_force_mps2 + sensors.accel_bias_mps2 + sensors.accel_noise_mps2 * noise


def _draws(rng: np.random.Generator) -> Iterator[list[float]]:
    """Yield five standard normal numbers at a time, drawn by the thousand: it is quicker."""
    while True:
        yield from rng.standard_normal((200, 5)).tolist()
