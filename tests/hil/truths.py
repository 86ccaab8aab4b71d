"""Truths to judge without driving for them."""

import numpy as np

from plant_emulator.truth import TRUTH_DTYPE
from tcs_hil.hil.metrics import Truth
from tcs_hil.model.vehicle import Vehicle


def steady(samples: int = 1000) -> Truth:
    """Two seconds at 2 ms on mu 0.3, full request, both front wheels at slip 0.1."""
    rows = np.zeros(samples, TRUTH_DTYPE)
    rows["time_s"] = 0.002 * np.arange(samples)
    rows["speed_mps"] = 5.0
    rows["request_nm"] = 250.0
    rows["motor_torque_nm"] = 130.0
    rows["slip_ratio"][:, :2] = 0.1
    rows["load_n"] = Vehicle().wheel_load_n
    rows["mu"] = 0.3
    return rows
