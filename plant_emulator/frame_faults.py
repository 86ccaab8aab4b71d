"""Faults on encoded frames, and on the nodes that send and hear them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from e2e.p02 import e2e_p02_protect

from plant_emulator.faults import MESSAGES, UNPROTECTED, Fault
from plant_emulator.virtual_bus import Sender
from tcs_hil.canbus.database import Database
from tcs_hil.canbus.e2e import COUNTER_MASK


class TimedFrame(NamedTuple):
    """A frame, when its node offers it to the bus, ns from the start, and in which mailbox."""

    time_ns: int
    frame_id: int
    data: bytes
    mailbox: int = 0


class FrameFaults:
    """Turns each frame a node wants to send into those it sends: none, one or two."""

    def __init__(
        self, faults: tuple[Fault, ...], database: Database, rng: np.random.Generator
    ) -> None:
        self._rng = rng
        self._database = database
        self._on_messages = [
            (database.messages[fault.target].frame_id, fault)
            for fault in faults
            if fault.target in (*MESSAGES, *UNPROTECTED)
        ]
        self._silenced = {
            Sender.VEHICLE: _of(faults, "VEHICLE", "bus-off", "brown-out"),
            Sender.SERVICE: _of(faults, "TCS", "bus-off"),
        }
        self._babblers = _of(faults, "VEHICLE", "babbling")
        self._counters: dict[int, int] = {}

    def pass_on(self, frame: TimedFrame, sender: Sender) -> list[TimedFrame]:
        """What becomes of ``frame``; several faults on one message act in the order listed."""
        time_s = frame.time_ns * 1e-9
        if any(fault.active(time_s) for fault in self._silenced[sender]):
            return []
        frames = [frame]
        for frame_id, fault in self._on_messages:
            if frame_id == frame.frame_id:
                frames = [after for before in frames for after in self._act(fault, before)]
        return frames

    def deaf(self, time_s: float) -> bool:
        """Whether the vehicle hears nothing."""
        return any(fault.active(time_s) for fault in self._silenced[Sender.VEHICLE])

    def babble(self, start_ns: int, end_ns: int) -> Iterator[TimedFrame]:
        """Yield the frames a babbling vehicle adds from ``start_ns`` up to ``end_ns``."""
        for fault in self._babblers:
            period_ns = round(fault.period_s * 1e9)
            for time_ns in range(-(-start_ns // period_ns) * period_ns, end_ns, period_ns):
                if fault.active(time_ns * 1e-9):
                    yield TimedFrame(time_ns, fault.frame_id, bytes(8))

    def _act(self, fault: Fault, frame: TimedFrame) -> list[TimedFrame]:
        if fault.kind == "frozen-counter":
            return [self._freeze(fault, frame)]
        if not fault.active(frame.time_ns * 1e-9) or self._rng.random() >= fault.probability:
            return [frame]
        if fault.kind == "delayed":
            return [frame._replace(time_ns=frame.time_ns + round(fault.delay_s * 1e9))]
        if fault.kind == "bit-flip":
            return [frame._replace(data=self._flip(fault, frame.data))]
        if fault.kind == "wrong-crc":
            return [frame._replace(data=bytes([frame.data[0] ^ 0xFF]) + frame.data[1:])]
        # A duplicate waits beside the first, which it must not replace.
        twin = frame._replace(mailbox=frame.mailbox + 1)
        return [frame, twin] if fault.kind == "duplicated" else []

    def _flip(self, fault: Fault, data: bytes) -> bytes:
        bits = 8 * len(data)
        bit = int(self._rng.integers(bits)) if fault.bit is None else fault.bit % bits
        altered = bytearray(data)
        altered[bit // 8] ^= 1 << bit % 8
        return bytes(altered)

    def _freeze(self, fault: Fault, frame: TimedFrame) -> TimedFrame:
        """Sign the frame anew with the counter of the last one before the fault."""
        counter = frame.data[1] & COUNTER_MASK
        if not fault.active(frame.time_ns * 1e-9):
            self._counters[frame.frame_id] = counter
            return frame
        e2e = self._database.messages[fault.target].e2e
        frozen = self._counters.setdefault(frame.frame_id, counter)
        payload = bytearray(frame.data)
        # Signing moves the counter on by one.
        payload[1] = payload[1] & ~COUNTER_MASK & 0xFF | (frozen - 1) & COUNTER_MASK
        if e2e is not None:
            e2e_p02_protect(payload, e2e.data_ids)
        return frame._replace(data=bytes(payload))


def _of(faults: tuple[Fault, ...], target: str, *kinds: str) -> list[Fault]:
    return [fault for fault in faults if fault.target == target and fault.kind in kinds]
