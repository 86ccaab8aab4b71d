"""What really happens in the plant: the record no controller ever sees."""

from __future__ import annotations

from typing import NamedTuple, get_type_hints

import numpy as np

from tcs_hil.signals import FourWheels, Pair


class Truth(NamedTuple):
    """State of the plant at one instant, in SI units.

    Wheels come as fl, fr, rl, rr, motors and shafts as left, right.  Motor
    quantities are on the motor side of the gear, shaft quantities on the wheel
    side.  ``slip_ratio`` is the paper's modified kappa of the wheel's and the
    body's true speeds; ``tyre_slip_ratio`` the lagged one that makes the force.
    """

    time_s: float
    distance_m: float
    speed_mps: float
    accel_mps2: float
    pitch_rad: float
    heave_m: float
    grade_ratio: float
    request_nm: float
    limit_nm: Pair
    motor_torque_nm: Pair
    motor_speed_radps: Pair
    shaft_twist_rad: Pair
    shaft_torque_nm: Pair
    wheel_speed_radps: FourWheels
    slip_speed_mps: FourWheels
    slip_ratio: FourWheels
    tyre_slip_ratio: FourWheels
    force_n: FourWheels
    load_n: FourWheels
    mu: FourWheels


_WIDTHS: dict[object, int] = {float: 1, Pair: 2, FourWheels: 4}

TRUTH_DTYPE = np.dtype(
    [
        (name, np.float64) if _WIDTHS[kind] == 1 else (name, np.float64, (_WIDTHS[kind],))
        for name, kind in get_type_hints(Truth).items()
    ]
)
"""One row of a recording: the fields of `Truth`, all float64, wheels and sides as sub-arrays."""
