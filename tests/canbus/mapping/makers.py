"""Three invented makers' cars: our signals on their buses, and their limits back.

cantools packs and unpacks, checksums are worked out bit by bit below: nothing
here is the code under test.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import reduce
from operator import xor
from pathlib import Path

import cantools

from tcs_hil.config import read_toml
from tcs_hil.service.settings import ServiceConfig
from tcs_hil.signals import NO_LIMIT, Measurement, TorqueLimits

FOLDER = Path("tests/data/dbc")
RADIUS_M = 0.318
GEAR = 3.0
RPM = 60.0 / (2.0 * math.pi)
KMPH = 3.6 * RADIUS_M
GRAVITY_MPS2 = 9.81

Values = Mapping[str, float]
Sign = Callable[[bytearray, int], None]
"""Writes counter and checksum of a frame that was packed with both zero."""


@dataclass(frozen=True)
class Talk:
    """One message of a car: when it is due, what it says, how it is signed."""

    message: str
    every: int  # ticks
    values: Callable[[Measurement], Values]
    sign: Sign


@dataclass(frozen=True)
class Maker:
    name: str
    talks: tuple[Talk, ...]
    limit_message: str
    limits: Callable[[Values], TorqueLimits]
    sign_limit: Sign

    @property
    def toml(self) -> Path:
        return FOLDER / f"{self.name}.toml"

    def config(self) -> ServiceConfig:
        return read_toml(self.toml, ServiceConfig)

    def dbc(self) -> cantools.database.Database:
        return cantools.database.load_file(FOLDER / f"{self.name}.dbc")


class Car:
    """What a maker's car says in each tick, and what it understands of the service."""

    def __init__(self, maker: Maker) -> None:
        self._maker = maker
        self._dbc = maker.dbc()
        self._tick = 0
        self._counts: dict[str, int] = {}

    def frames(self, measurement: Measurement) -> list[tuple[int, bytes]]:
        """Frames of the next tick."""
        due = [talk for talk in self._maker.talks if self._tick % talk.every == 0]
        self._tick += 1
        return [self._frame(talk, measurement) for talk in due]

    def limits(self, frame_id: int, data: bytes) -> TorqueLimits | None:
        """Limits in a frame of the service; None where it is another frame.

        Counter and checksum must be those that come next.
        """
        message = self._dbc.get_message_by_name(self._maker.limit_message)
        if frame_id != message.frame_id:
            return None
        values = message.decode(data)
        expected = bytearray(data)
        self._maker.sign_limit(expected, self._next(message.name))
        assert data.hex() == expected.hex()
        return self._maker.limits(values)

    def _frame(self, talk: Talk, measurement: Measurement) -> tuple[int, bytes]:
        message = self._dbc.get_message_by_name(talk.message)
        values = talk.values(measurement)
        rest = {s.name: s.offset for s in message.signals if s.name not in values}
        payload = bytearray(message.encode({**values, **rest}, strict=False))
        talk.sign(payload, self._next(talk.message))
        return message.frame_id, bytes(payload)

    def _next(self, name: str) -> int:
        self._counts[name] = self._counts.get(name, 0) + 1
        return self._counts[name]


def crc8(polynomial: int, data: bytes, initial: int = 0xFF, final_xor: int = 0xFF) -> int:
    """CRC of eight bits, most significant bit first (AUTOSAR SWS CRC Library)."""
    crc = initial
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc << 1 ^ polynomial if crc & 0x80 else crc << 1) & 0xFF
    return crc ^ final_xor


# --- Montane -----------------------------------------------------------------------------


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


def _nothing(_frame: bytearray, _count: int) -> None:
    """No counter, no checksum."""


def _wheels(left: int, names: tuple[str, str], unit: float) -> Callable[[Measurement], Values]:
    def values(m: Measurement) -> Values:
        pair = m.wheel_speed_radps[left : left + 2]
        return {name: speed * unit for name, speed in zip(names, pair, strict=True)}

    return values


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
            _wheels(0, ("WhlSpd_FL", "WhlSpd_FR"), KMPH),
            _in_last_bytes(lambda data: reduce(xor, data)),
        ),
        Talk(
            "ABS_WhlSpd_Rear",
            1,
            _wheels(2, ("WhlSpd_RL", "WhlSpd_RR"), KMPH),
            _in_last_bytes(lambda data: reduce(xor, data, 0xA5)),
        ),
        Talk("ABS_LongAcc", 1, _montane_accel, _nothing),
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

# --- Quendal -----------------------------------------------------------------------------

QUENDAL_FULL_NM = 260.0


def _split(low: tuple[int, int, int], high: tuple[int, int, int]) -> Sign:
    """Counter of four bits in two places: each byte, shift and number of bits."""

    def sign(frame: bytearray, count: int) -> None:
        count %= 16
        for byte, shift, bits in (low, high):
            mask = (1 << bits) - 1
            frame[byte] = frame[byte] & ~(mask << shift) & 0xFF | (count & mask) << shift
            count >>= bits

    return sign


_WHEEL_SPLIT = (0, 3, 2), (6, 6, 2)


def _page(page: int, left: int, names: tuple[str, str]) -> Callable[[Measurement], Values]:
    speeds = _wheels(left, names, KMPH)
    return lambda m: {"WHL_Page": page, **speeds(m)}


def _quendal_limits(values: Values) -> TorqueLimits:
    assert values["TCU_Page"] == 1
    percent = (values["TCU_MaxL"], values["TCU_MaxR"])
    limits = [NO_LIMIT if p == 4095 * 0.03 else p / 100.0 * QUENDAL_FULL_NM for p in percent]
    assert values["TCU_Intervene"] == (2 if min(limits) < NO_LIMIT else 1)
    return TorqueLimits(*limits)


def _quendal_demand(m: Measurement) -> Values:
    left, right = (100.0 * torque_nm / QUENDAL_FULL_NM for torque_nm in m.driver_torque_nm)
    return {"DRV_PedL": left, "DRV_PedR": right}


QUENDAL = Maker(
    name="quendal",
    talks=(
        Talk("WHL_DATA", 1, _page(1, 0, ("WHL_VL", "WHL_VR")), _split(*_WHEEL_SPLIT)),
        Talk("WHL_DATA", 1, _page(2, 2, ("WHL_HL", "WHL_HR")), _split(*_WHEEL_SPLIT)),
        Talk("DRV_REQ", 5, _quendal_demand, _split((1, 5, 1), (3, 5, 3))),
    ),
    limit_message="TCU_LIM",
    limits=_quendal_limits,
    sign_limit=_split((0, 2, 2), (3, 6, 2)),
)

# --- Aurelis -----------------------------------------------------------------------------

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
            _wheels(0, ("WheelFrLe_n", "WheelFrRi_n"), RPM),
            _profile_1(0x0140, "both"),
        ),
        Talk(
            "EscWheelRe",
            1,
            _wheels(2, ("WheelReLe_n", "WheelReRi_n"), RPM),
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

MAKERS = (MONTANE, QUENDAL, AURELIS)
