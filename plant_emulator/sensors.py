"""The sensors as a scenario describes them."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from plant_emulator.bounds import TEETH_MAX, Finite, NonNegative, Positive, Seed, Table

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
