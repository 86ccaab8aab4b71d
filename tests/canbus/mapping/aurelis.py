"""Aurelis: AUTOSAR profiles, rpm, torques at the wheel."""

from __future__ import annotations

import math

from tcs_hil.signals import NO_LIMIT, Measurement, TorqueLimits

from .car import GEAR, RPM, Maker, Sign, Talk, Values, crc8, wheels

EDU_DEMAND_IDS = bytes.fromhex("98C25117E90B7D3486F04FAA2DB8136E")


def _profile_1(data_id: int, mode: str) -> Sign:
    """CRC-8 SAE J1850, started at 0 and not inverted, over the data id's bytes and the frame."""
    low, high = data_id & 0xFF, data_id >> 8

    def sign(frame: bytearray, count: int) -> None:
        count %= 15
        frame[1] = frame[1] & 0xF0 | count
        if mode == "nibble":
            frame[1] = (high & 0x0F) << 4 | count
        covered = {
            "both": bytes([low, high]),
            "low": bytes([low]),
            "alternating": bytes([high if count % 2 else low]),
            "nibble": bytes([low, 0]),
        }[mode]
        frame[0] = crc8(0x1D, covered + frame[1:], initial=0, final_xor=0)

    return sign


def _profile_2(data_ids: bytes) -> Sign:
    def sign(frame: bytearray, count: int) -> None:
        frame[1] = frame[1] & 0xF0 | count % 16
        frame[0] = crc8(0x2F, bytes(frame[1:]) + data_ids[count % 16 : count % 16 + 1])

    return sign


def _edu_motor_sign(frame: bytearray, count: int) -> None:
    frame[0] = frame[0] & 0xF0 | count % 16
    frame[7] = crc8(0x2F, bytes(frame[:7]) + b"\x50\x3c")


def _edu_motor(m: Measurement) -> Values:
    (speed_left, speed_right), (left_nm, right_nm) = m.motor_speed_radps, m.motor_torque_nm
    return {
        "MotLe_n": speed_left * RPM,
        "MotRi_n": speed_right * RPM,
        "MotLe_M": left_nm,
        "MotRi_M": right_nm,
    }


def _edu_demand(m: Measurement) -> Values:
    left_nm, right_nm = m.driver_torque_nm
    return {"DemandLe_M": left_nm * GEAR, "DemandRi_M": right_nm * GEAR}


def _body(m: Measurement) -> Values:
    known = math.isfinite(m.accel_x_mps2)
    return {"Body_ax": m.accel_x_mps2 if known else 0xFFFF * 0.001 - 32.0}


def _aurelis_limits(values: Values) -> TorqueLimits:
    limits = [
        values[f"Trc{side}_M"] / GEAR if values[f"Trc{side}_Act"] else NO_LIMIT
        for side in ("Le", "Ri")
    ]
    for side, limit in zip(("Le", "Ri"), limits, strict=True):
        assert (values[f"Trc{side}_M"] == 3000.0) == (limit == NO_LIMIT)
    return TorqueLimits(*limits)


AURELIS = Maker(
    name="aurelis",
    talks=(
        Talk(
            "EscWheelFr",
            1,
            wheels(0, ("WheelFrLe_n", "WheelFrRi_n"), RPM),
            _profile_1(0x0140, "both"),
        ),
        Talk(
            "EscWheelRe",
            1,
            wheels(2, ("WheelReLe_n", "WheelReRi_n"), RPM),
            _profile_1(0x0141, "low"),
        ),
        Talk("EduMotor", 1, _edu_motor, _edu_motor_sign),
        Talk("EduDemand", 5, _edu_demand, _profile_2(EDU_DEMAND_IDS)),
        Talk("EscBody", 1, _body, _profile_1(0x0161, "alternating")),
    ),
    limit_message="TrcLimit",
    limits=_aurelis_limits,
    sign_limit=_profile_1(0x0260, "nibble"),
)
