"""Faults on values: signals, torque limits received, and motors."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from tcs_hil.fault_codes import FaultCode as Code
from tcs_hil.hil.faults.cell import Cell, Promise
from tcs_hil.hil.faults.promises import (
    AGREED_S,
    BEHIND,
    DRIVER_TOLD_S,
    GRADE,
    PEDAL,
    SMALL,
    STILL_TRUE,
    TOO_SHORT,
    UNCONTRADICTED,
    found,
    nothing,
    told,
)
from tcs_hil.signals import TcsState

LASTS_S = 0.4

Family = tuple[str, Mapping[str, float]]

FAMILIES: dict[str, Family] = {
    "off": ("off", {}),
    "stuck": ("stuck", {}),
    "garbage": ("garbage", {"low": 0.0, "high": 60.0}),
    "half": ("wrong", {"scale": 0.5}),
    "2 % high": ("wrong", {"scale": 1.02}),
    "lag of 0.1 s": ("slow", {"time_constant_s": 0.1}),
    "20 ms late": ("delayed", {"delay_s": 0.02}),
    "loose contact": ("intermittent", {"period_s": 0.05, "duty": 0.4}),
}
"""In words, the emulator's kind and its numbers."""

FRONT = nothing(STILL_TRUE, Code.FRONT_SPEED_IMPLAUSIBLE)
REAR = nothing(STILL_TRUE, Code.ONE_REAR_SPEED_IMPLAUSIBLE)
REARS = nothing(STILL_TRUE, Code.REAR_SPEEDS_IMPLAUSIBLE, Code.ONE_REAR_SPEED_IMPLAUSIBLE)
MOTOR_CODES = (Code.MOTOR_STATE_IMPLAUSIBLE, Code.FRONT_WHEEL_UNKNOWN)
MOTOR_BACK_S = AGREED_S + 0.1
"""Wheel and motor may go on disagreeing while a spinning wheel is caught."""
SMALL_MOTOR = nothing(SMALL, *MOTOR_CODES, back_s=MOTOR_BACK_S)
TORQUE = nothing(UNCONTRADICTED, Code.MOTOR_STATE_IMPLAUSIBLE)
REQUEST = nothing(PEDAL, Code.DRIVER_REQUEST_IMPLAUSIBLE)

SPEED_FL = {
    "off": told(Code.FRONT_SPEED_INVALID),
    "stuck": FRONT,
    "garbage": found(0.15, Code.FRONT_SPEED_IMPLAUSIBLE),
    "half": FRONT,
    "2 % high": nothing(SMALL),
    "lag of 0.1 s": nothing(SMALL),
    "20 ms late": nothing(SMALL),
    "loose contact": told(Code.FRONT_SPEED_INVALID),
}
SPEED_RL = {
    "off": told(Code.ONE_REAR_SPEED_INVALID),
    "stuck": REAR,
    "garbage": found(0.1, Code.ONE_REAR_SPEED_IMPLAUSIBLE),
    "half": found(0.1, Code.ONE_REAR_SPEED_IMPLAUSIBLE),
    "2 % high": nothing(SMALL),
    "lag of 0.1 s": nothing(SMALL),
    "20 ms late": nothing(SMALL),
    "loose contact": told(Code.ONE_REAR_SPEED_INVALID),
}
SPEEDS_REAR = {
    "off": told(Code.REAR_SPEEDS_INVALID, state=TcsState.FAULT),
    "stuck": REARS,
    "garbage": found(0.1, Code.REAR_SPEEDS_IMPLAUSIBLE, state=TcsState.FAULT),
    "half": found(0.1, Code.REAR_SPEEDS_IMPLAUSIBLE, state=TcsState.FAULT),
    "2 % high": nothing(SMALL),
    "lag of 0.1 s": nothing(SMALL),
    "20 ms late": nothing(SMALL),
    "loose contact": told(Code.REAR_SPEEDS_INVALID, state=TcsState.FAULT),
}
MOTOR_SPEED = {
    "off": found(0.15, *MOTOR_CODES, back_s=MOTOR_BACK_S),
    "stuck": nothing(STILL_TRUE, *MOTOR_CODES, back_s=MOTOR_BACK_S),
    "garbage": found(0.25, *MOTOR_CODES, back_s=MOTOR_BACK_S),
    "half": found(0.1, *MOTOR_CODES, back_s=MOTOR_BACK_S),
    "loose contact": nothing(TOO_SHORT, Code.FRONT_SPEED_IMPLAUSIBLE, *MOTOR_CODES),
}
DRIVER = {
    # It shows once the limit, which went down with the request, is lifted: 20 ms and a lag.
    "off": found(
        0.1 + DRIVER_TOLD_S + 0.04,
        Code.DRIVER_REQUEST_IMPLAUSIBLE,
        state=TcsState.FAULT,
        back_s=DRIVER_TOLD_S + 0.02,
    ),
}
ACCELERATION = {
    "garbage": found(0.01, Code.ACCELERATION_IMPLAUSIBLE, back_s=1.0 + AGREED_S),
}

Promises = Mapping[str, Promise]

TARGETS: dict[tuple[str, ...], tuple[Promises, Promise]] = {
    ("WheelSpeedFL",): (SPEED_FL, FRONT),
    ("WheelSpeedRL",): (SPEED_RL, REAR),
    ("WheelSpeedRL", "WheelSpeedRR"): (SPEEDS_REAR, REARS),
    ("MotorSpeedL",): (MOTOR_SPEED, SMALL_MOTOR),
    ("MotorTorqueL",): ({}, TORQUE),
    ("DriverTorqueRequestL",): (DRIVER, REQUEST),
    ("VehicleAccelX",): (ACCELERATION, nothing(GRADE)),
    ("TorqueLimitL",): ({}, nothing(BEHIND)),
    ("MotorL",): ({}, nothing(UNCONTRADICTED, Code.MOTOR_STATE_IMPLAUSIBLE)),
}
"""What is owed by the family, and what to those that are not named."""

# At walking pace a shaft that twists shows as much.
SLOW: Mapping[tuple[str, ...], Promise] = {("MotorSpeedL", "half"): SMALL_MOTOR}


def value_cells() -> Iterator[Cell]:
    """Every kind a value's fault can have, on one signal of each sort."""
    for targets, (promises, otherwise) in TARGETS.items():
        for family, (kind, numbers) in FAMILIES.items():
            promise = promises.get(family, otherwise)
            slow = SLOW.get((*targets, family))
            yield Cell(family, targets, kind, promise, LASTS_S, numbers, slow)
    yield _tooth("WheelSpeedFL", nothing(SMALL))
    yield _tooth("WheelSpeedRL", REAR)
    ignored = nothing(BEHIND)
    yield Cell("ignores its limit", ("MotorL",), "ignores-limit", ignored, LASTS_S)


def _tooth(target: str, promise: Promise) -> Cell:
    return Cell("a tooth missing", (target,), "tooth-missing", promise, LASTS_S, {"tooth": 7})
