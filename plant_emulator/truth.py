"""What really happens in the plant: the record no controller ever sees."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple, TypeAlias, get_type_hints

import numpy as np
from numpy.typing import NDArray

from tcs_hil.names import column_names
from tcs_hil.signals import FourWheels, Pair


class Truth(NamedTuple):
    """State of the plant at one instant, in SI units.

    Wheels come as fl, fr, rl, rr, motors and shafts as left, right.  Motor
    quantities are on the motor side of the gear, shaft quantities on the wheel
    side.  ``slip_ratio`` is the paper's modified kappa of the wheel's and the
    body's true speeds; ``tyre_slip_ratio`` the lagged one that makes the force, its
    state ``transient_slip_ratio`` and the damping at low speed together.
    ``held`` is 1 while the parking hold is closed, ``hold_twist_rad`` how far each
    wheel has turned since it closed.
    ``specific_force_mps2`` is what an accelerometer along the body would feel.
    """

    time_s: float
    distance_m: float
    speed_mps: float
    accel_mps2: float
    specific_force_mps2: float
    pitch_rad: float
    heave_m: float
    grade_ratio: float
    request_nm: float
    limit_nm: Pair
    motor_torque_nm: Pair
    motor_speed_radps: Pair
    shaft_twist_rad: Pair
    shaft_torque_nm: Pair
    brake_torque_nm: FourWheels
    wheel_speed_radps: FourWheels
    slip_speed_mps: FourWheels
    slip_ratio: FourWheels
    tyre_slip_ratio: FourWheels
    force_n: FourWheels
    load_n: FourWheels
    mu: FourWheels
    heave_rate_mps: float
    pitch_rate_radps: float
    held: float
    wheel_angle_rad: FourWheels
    transient_slip_ratio: FourWheels
    hold_twist_rad: FourWheels


_WIDTHS: dict[object, int] = {float: 1, Pair: 2, FourWheels: 4}
_FIELDS = [(name, _WIDTHS[kind]) for name, kind in get_type_hints(Truth).items()]

TRUTH_DTYPE = np.dtype(
    [(name, np.float64) if width == 1 else (name, np.float64, (width,)) for name, width in _FIELDS]
)
"""One row of a recording: the fields of `Truth`, all float64, wheels and sides as sub-arrays."""

Row: TypeAlias = NDArray[np.float64]
"""The same as one flat array, (ROW_SIZE,), which is what compiled code fills in."""

ROW_SIZE = TRUTH_DTYPE.itemsize // 8
_STARTS = {name: int(TRUTH_DTYPE.fields[name][1]) // 8 for name, _ in _FIELDS}  # type: ignore[index]

TRUTH_COLUMNS = {
    column: place
    for name in _STARTS
    for place, column in enumerate(column_names(name, TRUTH_DTYPE[name].shape), _STARTS[name])
}
"""Name and place of every number in a row."""

TIME = _STARTS["time_s"]
DISTANCE = _STARTS["distance_m"]
BODY_SPEED = _STARTS["speed_mps"]
ACCEL = _STARTS["accel_mps2"]
SPECIFIC_FORCE = _STARTS["specific_force_mps2"]
PITCH = _STARTS["pitch_rad"]
HEAVE = _STARTS["heave_m"]
GRADE = _STARTS["grade_ratio"]
REQUEST = _STARTS["request_nm"]
LIMIT = _STARTS["limit_nm"]
MOTOR_TORQUE = _STARTS["motor_torque_nm"]
MOTOR_SPEED = _STARTS["motor_speed_radps"]
SHAFT_TWIST = _STARTS["shaft_twist_rad"]
SHAFT_TORQUE = _STARTS["shaft_torque_nm"]
BRAKE_TORQUE = _STARTS["brake_torque_nm"]
WHEEL_SPEED = _STARTS["wheel_speed_radps"]
SLIP_SPEED = _STARTS["slip_speed_mps"]
SLIP_RATIO = _STARTS["slip_ratio"]
TYRE_SLIP = _STARTS["tyre_slip_ratio"]
FORCE = _STARTS["force_n"]
LOAD = _STARTS["load_n"]
MU = _STARTS["mu"]
HEAVE_RATE = _STARTS["heave_rate_mps"]
PITCH_RATE = _STARTS["pitch_rate_radps"]
HELD = _STARTS["held"]
WHEEL_ANGLE = _STARTS["wheel_angle_rad"]
TRANSIENT_SLIP = _STARTS["transient_slip_ratio"]
HOLD_TWIST = _STARTS["hold_twist_rad"]


def truth_of(row: Row) -> Truth:
    """Name the numbers of a row."""
    values = row.tolist()
    fields: Iterator[Any] = (
        values[_STARTS[name]] if width == 1 else tuple(values[_STARTS[name] :][:width])
        for name, width in _FIELDS
    )
    return Truth(*fields)
