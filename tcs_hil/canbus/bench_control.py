"""What a person at the bench may ask of a running emulator."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple


class BenchFault(IntEnum):
    """Fault the emulator has ready, numbered as in the DBC's value table."""

    NONE = 0
    WHEEL_SPEED_FL_STUCK = 1
    WHEEL_SPEED_RL_OFF = 2
    WHEEL_SPEEDS_REAR_DROPPED = 3
    DRIVER_REQUEST_WRONG_CRC = 4
    MOTOR_STATE_DROPPED = 5
    TORQUE_LIMIT_DROPPED = 6
    VEHICLE_BABBLING = 7
    VEHICLE_BROWN_OUT = 8


class BenchControl(NamedTuple):
    """What takes the place of the scenario's driver and road; None leaves it to the scenario.

    ``throttle_nm`` is asked of each motor, ``mu_ratio`` is the friction under every
    wheel.  The fault comes on top of the scenario's own.
    """

    throttle_nm: float | None = None
    mu_ratio: float | None = None
    fault: BenchFault = BenchFault.NONE


AS_IN_SCENARIO = BenchControl()
"""Drive on as if nobody had touched anything."""
