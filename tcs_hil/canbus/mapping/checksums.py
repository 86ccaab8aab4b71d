"""Checksums of one byte, as carmakers build them.

The CRCs are autosar-e2e's; a start or final value other than the standard's is
a matter of exclusive-or around them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import reduce
from operator import xor
from typing import Literal

from e2e.crc import calculate_crc8, calculate_crc8_h2f

ChecksumKind = Literal["xor", "sum", "sum-complement", "crc8-j1850", "crc8-h2f"]
Digest = Callable[[bytes], int]
"""Bytes covered, in order -> the byte to be sent."""

CRC_KINDS = ("crc8-j1850", "crc8-h2f")
CRC_PRESET = 0xFF
"""Initial value and final exclusive-or of both CRCs (AUTOSAR SWS CRC Library)."""


@dataclass(frozen=True, slots=True)
class Checksum:
    """One byte of a frame, made of all the others and of a data id that is not sent."""

    byte: int
    kind: ChecksumKind
    initial: int
    final_xor: int
    prefix: bytes = b""
    suffix: bytes = b""


class Seal:
    """Reads and writes the checksum of whole frames."""

    def __init__(self, spec: Checksum) -> None:
        self._byte, self._prefix, self._suffix = spec.byte, spec.prefix, spec.suffix
        self._digest = _KINDS[spec.kind](spec.initial, spec.final_xor)

    def holds(self, frame: bytes) -> bool:
        """Whether the frame carries the checksum of its own bytes."""
        return self._of(frame) == frame[self._byte]

    def put(self, frame: bytearray) -> None:
        """Write the checksum of all other bytes."""
        frame[self._byte] = self._of(frame)

    def _of(self, frame: bytes | bytearray) -> int:
        before, after = frame[: self._byte], frame[self._byte + 1 :]
        return self._digest(b"".join((self._prefix, before, after, self._suffix)))


def _xor(initial: int, final_xor: int) -> Digest:
    def digest(covered: Iterable[int]) -> int:
        return reduce(xor, covered, initial) ^ final_xor

    return digest


def _sum(initial: int, final_xor: int) -> Digest:
    def digest(covered: Iterable[int]) -> int:
        return (sum(covered, initial) & 0xFF) ^ final_xor

    return digest


def _sum_complement(initial: int, final_xor: int) -> Digest:
    def digest(covered: Iterable[int]) -> int:
        return (-sum(covered, initial) & 0xFF) ^ final_xor

    return digest


def _crc8(calculate: Callable[[bytes, int, bool], int]) -> Callable[[int, int], Digest]:
    def with_values(initial: int, final_xor: int) -> Digest:
        # The library takes what an earlier call returned, and undoes its final exclusive-or.
        start, after = initial ^ CRC_PRESET, final_xor ^ CRC_PRESET

        def digest(covered: bytes) -> int:
            return calculate(covered, start, False) ^ after

        return digest

    return with_values


_KINDS: dict[ChecksumKind, Callable[[int, int], Digest]] = {
    "xor": _xor,
    "sum": _sum,
    "sum-complement": _sum_complement,
    "crc8-j1850": _crc8(calculate_crc8),
    "crc8-h2f": _crc8(calculate_crc8_h2f),
}
