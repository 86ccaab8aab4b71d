"""What crosses the seam between the bus and the control code, in SI units.

Wheels come in the order fl, fr, rl, rr; driven wheels and motors in the order
left, right.  Torque and speed of a motor are on the motor side of the gear.
"""

from __future__ import annotations

import math
from enum import IntEnum
from typing import NamedTuple

import msgspec

Pair = tuple[float, float]
FourWheels = tuple[float, float, float, float]

NO_LIMIT = math.inf
"""A torque ceiling that binds nothing: the driver's request passes untouched."""


class TcsState(IntEnum):
    """State of the service, numbered as in the DBC's value table."""

    OFF = 0
    INIT = 1
    STANDBY = 2
    ACTIVE = 3
    DEGRADED = 4
    FAULT = 5


class ControllerKind(IntEnum):
    """Control law in charge, numbered as in the DBC's value table."""

    OFF = 0
    PI = 1
    KMPC = 2
    NMPC = 3


class InputState(IntEnum):
    """What the protection of one received message has come to (E2E state machine).

    NO_DATA before the first frame, INIT while too few were good, VALID, and
    INVALID once too many were not; ABSENT where the vehicle has no such message.
    """

    NO_DATA = 0
    INIT = 1
    VALID = 2
    INVALID = 3
    ABSENT = 4


class BusCondition(IntEnum):
    """Worst that the bus itself has shown since the tick before; worse is greater."""

    OK = 0
    OVERFLOW = 1  # frames were lost because nobody had read them
    SEND_FAILED = 2  # a limit could not be handed to the bus
    ERROR_PASSIVE = 3  # the CAN controller has seen many errors
    DOWN = 4  # interface down or removed
    BUS_OFF = 5  # the CAN controller has left the bus
    INTRUDER = 6  # somebody else sends what only we may send


class Suspect(IntEnum):
    """Bit of each input that may turn out to contradict the others; all fit one byte."""

    WHEEL_FL = 1
    WHEEL_FR = 2
    WHEEL_RL = 4
    WHEEL_RR = 8
    MOTOR_LEFT = 16
    MOTOR_RIGHT = 32
    ACCELEROMETER = 64
    DRIVER = 128


class Measurement(msgspec.Struct, frozen=True):
    """Newest value of every input, with the age of each source at the tick.

    An age is ``math.inf`` until the first good frame.  ``accel_x_mps2`` is NaN
    where the vehicle has no accelerometer on the bus.
    """

    wheel_speed_radps: FourWheels
    wheel_speed_valid: tuple[bool, bool, bool, bool]
    motor_speed_radps: Pair
    motor_torque_nm: Pair
    driver_torque_nm: Pair
    accel_x_mps2: float
    front_speed_age_s: float
    rear_speed_age_s: float
    motor_age_s: float
    driver_age_s: float
    front_speed_state: InputState = InputState.VALID
    rear_speed_state: InputState = InputState.VALID
    motor_state: InputState = InputState.VALID
    driver_state: InputState = InputState.VALID
    bus: BusCondition = BusCondition.OK


class TorqueLimits(NamedTuple):
    """Ceilings on the two front motors; ``NO_LIMIT`` where nothing is held."""

    left_nm: float = NO_LIMIT
    right_nm: float = NO_LIMIT


class RoadEstimate(msgspec.Struct, frozen=True):
    """What the service believes about road and loop, for display and logging.

    ``friction_ratio`` is mu under each front wheel, worth as much as its
    ``confidence_ratio`` in [0, 1] says; ``loop_delay_s`` is from a measurement
    to the first effect of the command that answers it.
    """

    friction_ratio: Pair
    confidence_ratio: Pair
    loop_delay_s: float


UNKNOWN_ROAD = RoadEstimate((0.0, 0.0), (0.0, 0.0), 0.0)
"""Nothing was estimated; the confidence says so."""


class Command(msgspec.Struct, frozen=True):
    """Everything one tick tells the vehicle."""

    limits: TorqueLimits
    active: tuple[bool, bool]
    state: TcsState
    fault_code: int
    controller: ControllerKind
    slip_ratio: Pair
    slip_reference: float
    road: RoadEstimate = UNKNOWN_ROAD
