"""Units as DBC files spell them, and their gain to what the service computes with.

Wheel and motor speeds are wanted in rad/s, torques in Nm at the motor's side of
the gear, accelerations in m/s².
"""

from __future__ import annotations

import math
from enum import Enum

from tcs_hil.model.vehicle import GRAVITY_MPS2, Vehicle


class Kind(Enum):
    """What a number measures; the value is the unit the service computes with."""

    WHEEL_SPEED = "rad/s"
    MOTOR_SPEED = "rad/s at the motor"
    TORQUE = "Nm at the motor"
    ACCELERATION = "m/s2"


PERCENT = "%"

_ROTATION = {"rad/s": 1.0, "rpm": 2.0 * math.pi / 60.0, "deg/s": math.pi / 180.0}
_TRAVEL = {"m/s": 1.0, "km/h": 1.0 / 3.6, "mph": 0.44704}
_TORQUE = {"Nm": 1.0, "kNm": 1000.0}
_ACCELERATION = {"m/s2": 1.0, "g": GRAVITY_MPS2}

_SPELLINGS = {
    "rad/s": ("rad/s", "radps", "rad/sec", "rads"),
    "rpm": ("rpm", "1/min", "u/min", "r/min", "rev/min", "min-1", "min^-1", "unit_minutinver"),
    "deg/s": ("deg/s", "°/s", "degree/s"),
    "m/s": ("m/s", "mps", "m/sec", "unit_meterpersecon"),
    "km/h": ("km/h", "kph", "kmh", "kmph", "unit_kilometerperhour"),
    "mph": ("mph", "mi/h"),
    "Nm": ("nm", "n.m", "n*m", "n·m", "n-m", "newtonmeter", "unit_newtonmeter"),
    "kNm": ("knm",),
    PERCENT: ("%", "percent", "unit_percen"),
    "m/s2": ("m/s2", "m/s^2", "m/s²", "m/s/s", "m/(s^2)", "mps2", "unit_meterpersecsquared"),
    "g": ("g", "g's", "unit_g"),
}
_UNIT_OF = {spelling: unit for unit, spellings in _SPELLINGS.items() for spelling in spellings}


def unit_of(text: str) -> str | None:
    """Our name of a unit, however it is spelt; None for one we do not know."""
    return _UNIT_OF.get(text.replace(" ", "").lower())


def units_for(kind: Kind) -> tuple[str, ...]:
    """Units in which a quantity of this kind may come."""
    return tuple(_gains(kind, Vehicle(), 1.0))


def gain(kind: Kind, unit: str, vehicle: Vehicle, full_scale_nm: float) -> float:
    """Service's unit per ``unit``, which is one of ``units_for(kind)``.

    ``full_scale_nm`` is what 100 % of a torque stand for.
    """
    return _gains(kind, vehicle, full_scale_nm)[unit]


def _gains(kind: Kind, vehicle: Vehicle, full_scale_nm: float) -> dict[str, float]:
    if kind is Kind.WHEEL_SPEED:
        radius_m = vehicle.wheel_radius_m
        return _ROTATION | {unit: mps / radius_m for unit, mps in _TRAVEL.items()}
    if kind is Kind.MOTOR_SPEED:
        return _ROTATION
    if kind is Kind.TORQUE:
        return _TORQUE | {PERCENT: full_scale_nm / 100.0}
    return _ACCELERATION
