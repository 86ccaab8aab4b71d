"""The sensors at work: what the car's electronics read of the truth."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from plant_emulator.encoder import Encoder, SpeedUnit, WheelMotion
from plant_emulator.sensors import Sensors
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
        self._unit: SpeedUnit | None = None
        if sensors.teeth and encoder is not None and rolling is not None:
            self._unit = SpeedUnit(encoder, rolling, sensors.dropout_s)

    def sample(self, row: Row) -> VehicleSignals:
        """Read every sensor at the instant of a row of the truth."""
        sensors, values = self._sensors, row.tolist()
        speed_l, speed_r, torque_l, torque_r, accel = next(self._noise)
        speed_noise, torque_noise = sensors.motor_speed_noise_radps, sensors.motor_torque_noise_nm
        speeds, valid = self._wheels(values)
        return VehicleSignals(
            speeds,
            valid,
            (
                values[MOTOR_SPEED] + speed_noise * speed_l,
                values[MOTOR_SPEED + 1] + speed_noise * speed_r,
            ),
            (
                values[MOTOR_TORQUE] + torque_noise * torque_l,
                values[MOTOR_TORQUE + 1] + torque_noise * torque_r,
            ),
            (values[REQUEST], values[REQUEST]),
            self._accel(values[SPECIFIC_FORCE], accel),
        )

    def _wheels(self, values: list[float]) -> tuple[FourWheels, tuple[bool, bool, bool, bool]]:
        if self._unit is None:
            fl, fr, rl, rr = [abs(speed) for speed in values[WHEEL_SPEED : WHEEL_SPEED + 4]]
        else:
            fl, fr, rl, rr = self._unit.sample(values[TIME])
        least = self._sensors.speed_min_radps
        valid = (fl >= least, fr >= least, rl >= least, rr >= least)
        if not all(valid):
            fl, fr, rl, rr = [
                speed if ok else 0.0 for speed, ok in zip((fl, fr, rl, rr), valid, strict=True)
            ]
        return (fl, fr, rl, rr), valid

    def _accel(self, specific_force_mps2: float, noise: float) -> float | None:
        sensors = self._sensors
        if not sensors.accelerometer:
            return None
        return specific_force_mps2 + sensors.accel_bias_mps2 + sensors.accel_noise_mps2 * noise


def _draws(rng: np.random.Generator) -> Iterator[list[float]]:
    """Yield five standard normal numbers at a time, drawn by the thousand: it is quicker."""
    while True:
        yield from rng.standard_normal((200, 5)).tolist()
