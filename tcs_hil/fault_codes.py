"""Every reason for which the service is not simply in STANDBY or ACTIVE."""

from __future__ import annotations

from enum import IntEnum


class FaultCode(IntEnum):
    """Value of ``TcsFaultCode`` on the bus; the tens tell the kind."""

    NONE = 0

    AWAITING_INPUT = 10
    FRONT_SPEED_LATE = 11
    REAR_SPEED_LATE = 12
    MOTOR_STATE_LATE = 13
    DRIVER_REQUEST_LATE = 14

    FRONT_SPEED_LOST = 21
    REAR_SPEED_LOST = 22
    DRIVER_REQUEST_LOST = 24

    FRONT_SPEED_CORRUPT = 31
    REAR_SPEED_CORRUPT = 32
    MOTOR_STATE_CORRUPT = 33
    DRIVER_REQUEST_CORRUPT = 34

    FRONT_SPEED_INVALID = 41
    ONE_REAR_SPEED_INVALID = 42
    REAR_SPEEDS_INVALID = 43
    FRONT_WHEEL_UNKNOWN = 44

    FRONT_SPEED_IMPLAUSIBLE = 51
    ONE_REAR_SPEED_IMPLAUSIBLE = 52
    REAR_SPEEDS_IMPLAUSIBLE = 53
    MOTOR_STATE_IMPLAUSIBLE = 54
    ACCELERATION_IMPLAUSIBLE = 55
    DRIVER_REQUEST_IMPLAUSIBLE = 56

    CONTROLLER_REPLACED = 61
    CONTROLLER_SILENT = 62
    CONTROLLER_LOST = 63

    OVERRUNS = 71
    INTERNAL_ERROR = 72

    BUS_OVERFLOW = 81
    SEND_FAILED = 82
    BUS_ERROR_PASSIVE = 83
    BUS_DOWN = 84
    BUS_OFF = 85
    BUS_INTRUDER = 86


MEANINGS = {
    FaultCode.NONE: "nothing is wrong",
    FaultCode.AWAITING_INPUT: "an input has not come yet, or too few of its frames were good",
    FaultCode.FRONT_SPEED_LATE: "more than two cycles of front wheel speeds are missing",
    FaultCode.REAR_SPEED_LATE: "more than two cycles of rear wheel speeds are missing",
    FaultCode.MOTOR_STATE_LATE: "more than two cycles of the motors' state are missing; "
    "the wheels' own sensors serve",
    FaultCode.DRIVER_REQUEST_LATE: "more than two cycles of the driver's request are missing",
    FaultCode.FRONT_SPEED_LOST: "more than ten cycles of front wheel speeds are missing",
    FaultCode.REAR_SPEED_LOST: "more than ten cycles of rear wheel speeds are missing",
    FaultCode.DRIVER_REQUEST_LOST: "more than ten cycles of the driver's request are missing",
    FaultCode.FRONT_SPEED_CORRUPT: "too many frames of front wheel speeds failed their E2E check",
    FaultCode.REAR_SPEED_CORRUPT: "too many frames of rear wheel speeds failed their E2E check",
    FaultCode.MOTOR_STATE_CORRUPT: "too many frames of the motors' state failed their E2E check; "
    "the wheels' own sensors serve",
    FaultCode.DRIVER_REQUEST_CORRUPT: "too many frames of the driver's request failed their "
    "E2E check",
    FaultCode.FRONT_SPEED_INVALID: "a front wheel's sensor says that it fails; its motor serves",
    FaultCode.ONE_REAR_SPEED_INVALID: "a rear wheel's sensor says that it fails; the other serves",
    FaultCode.REAR_SPEEDS_INVALID: "no rear wheel's speed is left: the car's speed is unknown",
    FaultCode.FRONT_WHEEL_UNKNOWN: "neither sensor nor motor says how fast a front wheel turns",
    FaultCode.FRONT_SPEED_IMPLAUSIBLE: "a front wheel's speed cannot be true; its motor serves",
    FaultCode.ONE_REAR_SPEED_IMPLAUSIBLE: "a rear wheel's speed cannot be true; the other serves",
    FaultCode.REAR_SPEEDS_IMPLAUSIBLE: "neither rear wheel's speed can be true",
    FaultCode.MOTOR_STATE_IMPLAUSIBLE: "a motor's speed or torque cannot be true; "
    "the wheels' own sensors serve",
    FaultCode.ACCELERATION_IMPLAUSIBLE: "the acceleration cannot be true; "
    "the tyres' forces stand in for it",
    FaultCode.DRIVER_REQUEST_IMPLAUSIBLE: "a motor gives more than the driver is said to ask",
    FaultCode.CONTROLLER_REPLACED: "a law could not decide; its last plan or a PI did",
    FaultCode.CONTROLLER_SILENT: "a law could not decide, and nothing stood in for it",
    FaultCode.CONTROLLER_LOST: "for more than ten ticks no law and no stand-in could decide",
    FaultCode.OVERRUNS: "five ticks in a row sent their limits after the deadline",
    FaultCode.INTERNAL_ERROR: "our own code broke in this tick",
    FaultCode.BUS_OVERFLOW: "frames were lost because nobody had read them",
    FaultCode.SEND_FAILED: "the bus did not take our limits",
    FaultCode.BUS_ERROR_PASSIVE: "the CAN controller has seen many errors",
    FaultCode.BUS_DOWN: "the interface is down or gone",
    FaultCode.BUS_OFF: "the CAN controller has left the bus",
    FaultCode.BUS_INTRUDER: "somebody else sends what only the service may send",
}
"""What each code says, for people."""
