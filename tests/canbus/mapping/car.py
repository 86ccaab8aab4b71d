"""Cars of invented makers: our signals on their buses, and their limits back.

cantools packs and unpacks, checksums are worked out bit by bit below: nothing
here is the code under test.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import cantools

from tcs_hil.service.settings import ServiceConfig, read_service
from tcs_hil.signals import Measurement, TorqueLimits

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
        return read_service(self.toml)

    def dbc(self) -> cantools.database.Database:
        return _dbc(self.name)


@cache
def _dbc(name: str) -> cantools.database.Database:
    return cantools.database.load_file(FOLDER / f"{name}.dbc")


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


def nothing(_frame: bytearray, _count: int) -> None:
    """No counter, no checksum."""


def wheels(left: int, names: tuple[str, str], unit: float) -> Callable[[Measurement], Values]:
    def values(m: Measurement) -> Values:
        pair = m.wheel_speed_radps[left : left + 2]
        return {name: speed * unit for name, speed in zip(names, pair, strict=True)}

    return values
