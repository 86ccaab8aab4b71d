"""Montane: offsets, Motorola order, sums and exclusive-ors, one torque of the axle."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import reduce
from operator import xor

from tcs_hil.signals import NO_LIMIT, Measurement, TorqueLimits

from .car import GEAR, GRAVITY_MPS2, KMPH, RPM, Maker, Sign, Talk, Values, nothing, wheels


def _in_last_bytes(checksum: Callable[[bytes], int]) -> Sign:
    """Counter in the low nibble of the last byte but one, checksum in the last."""

    def sign(frame: bytearray, count: int) -> None:
        frame[-2] = frame[-2] & 0xF0 | count % 16
        frame[-1] = checksum(bytes(frame[:-1]))

    return sign


def _inverter_sign(frame: bytearray, count: int) -> None:
    """Counter 0 to 14 in the low nibble of byte 1; byte 0 makes the sum of all bytes 0."""
    frame[1] = frame[1] & 0xF0 | count % 15
    frame[0] = -sum(frame[1:]) & 0xFF


def _montane_motors(m: Measurement) -> Values:
    """The right motor is mounted the other way round."""
    (speed_left, speed_right), (left_nm, right_nm) = m.motor_speed_radps, m.motor_torque_nm
    return {
        "INV_SpdL": speed_left * RPM,
        "INV_SpdR": -speed_right * RPM,
        "INV_TrqL": left_nm,
        "INV_TrqR": -right_nm,
    }


def _montane_accel(m: Measurement) -> Values:
    known = math.isfinite(m.accel_x_mps2)
    return {"LongAcc": m.accel_x_mps2 / GRAVITY_MPS2 if known else 0.0, "LongAcc_Q": int(known)}


def _montane_limits(values: Values) -> TorqueLimits:
    assert values["TCS_Mode"] == 2
    limits = [
        values[f"TCS_Lim{side}"] if values[f"TCS_Act{side}"] else NO_LIMIT for side in ("L", "R")
    ]
    for side, limit in zip(("L", "R"), limits, strict=True):
        assert (values[f"TCS_Lim{side}"] == 923.75) == (limit == NO_LIMIT)  # raw 4095
    return TorqueLimits(*limits)


MONTANE = Maker(
    name="montane",
    talks=(
        Talk(
            "ABS_WhlSpd_Frnt",
            1,
            wheels(0, ("WhlSpd_FL", "WhlSpd_FR"), KMPH),
            _in_last_bytes(lambda data: reduce(xor, data)),
        ),
        Talk(
            "ABS_WhlSpd_Rear",
            1,
            wheels(2, ("WhlSpd_RL", "WhlSpd_RR"), KMPH),
            _in_last_bytes(lambda data: reduce(xor, data, 0xA5)),
        ),
        Talk("ABS_LongAcc", 1, _montane_accel, nothing),
        Talk("INV_State", 1, _montane_motors, _inverter_sign),
        Talk(
            "VCU_Demand",
            5,
            lambda m: {"VCU_AxleTrq": sum(m.driver_torque_nm) * GEAR},
            _in_last_bytes(lambda data: sum(data) & 0xFF ^ 0xFF),
        ),
    ),
    limit_message="TCS_TrqLim",
    limits=_montane_limits,
    sign_limit=_in_last_bytes(lambda data: sum(data) & 0xFF),
)
