"""The lifted state of the Koopman bank: what the bus says of one driven wheel, now and before."""

from __future__ import annotations

import math
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tcs_hil.model.tyre import Functions, slip_ratio
from tcs_hil.model.vehicle import Vehicle

FloatArray = NDArray[np.float64]


class Observable(IntEnum):
    """Elements of z, in SI units.

    Motor lag, half-shaft and tyre relaxation have states no sensor shows.  The
    same signals one period earlier stand in for them (a delay embedding): the
    change of the motor's speed tells the shaft's torque, the change of its
    torque the command that acts.
    """

    SLIP_SPEED = 0
    WHEEL_SPEED = 1
    SLIP_RATIO = 2
    TYRE = 3  # sin(C atan(B kappa)): the believed tyre force over its peak
    TWIST_RATE = 4  # motor speed, seen from the wheel, minus wheel speed
    TWIST_RATE_BEFORE = 5
    MOTOR_CHANGE = 6  # of the motor speed, seen from the wheel, in one period
    TORQUE = 7
    TORQUE_BEFORE = 8
    ONE = 9


NZ = len(Observable)


class Sample(NamedTuple):
    """What the bus says of one wheel at one instant, as floats or columns of equal shape."""

    slip_speed_mps: Any
    wheel_speed_radps: Any
    motor_speed_radps: Any  # seen from the wheel
    motor_torque_nm: Any


def lift(now: Sample, before: Sample, vehicle: Vehicle) -> FloatArray:
    """Lifted state (..., NZ) of columns (...,)."""
    return np.stack(np.broadcast_arrays(*_observables(now, before, vehicle, np)), axis=-1)


def lift_one(now: Sample, before: Sample, vehicle: Vehicle) -> FloatArray:
    """Lifted state (NZ,) of one wheel given as floats; ten times faster than `lift`."""
    return np.array(_observables(now, before, vehicle, math))


def _observables(now: Sample, before: Sample, vehicle: Vehicle, functions: Any) -> tuple[Any, ...]:
    slip_speed, omega, motor, torque = now
    kappa = slip_ratio(slip_speed, omega, vehicle)
    return (
        slip_speed,
        omega,
        kappa,
        _normal_force(kappa, vehicle, functions),
        motor - omega,
        before.motor_speed_radps - before.wheel_speed_radps,
        motor - before.motor_speed_radps,
        torque,
        before.motor_torque_nm,
        1.0,
    )


def _normal_force(kappa: Any, vehicle: Vehicle, functions: Functions) -> Any:
    return functions.sin(vehicle.tyre_c * functions.atan(vehicle.tyre_b * kappa))
