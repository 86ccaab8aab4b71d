"""How a port reaches a bus: through python-can, which speaks to everything."""

from __future__ import annotations

import select
from typing import Protocol

import can

from tcs_hil.canbus.embedded import EmbeddedBus
from tcs_hil.canbus.frame import Frame, PortCounters
from tcs_hil.canbus.health import BusHealth
from tcs_hil.canbus.stamps import stamping_of

DRAIN_LIMIT = 256
"""Frames taken at once: a babbling node must not keep the tick from its work."""


class Link(Protocol):
    """The way to one open bus; every method may raise ``can.CanError`` or ``OSError``."""

    def drain(self, frames: list[Frame]) -> None:
        """Append what has come, oldest first, without waiting; at most ``DRAIN_LIMIT``."""
        ...

    def send(self, frame_id: int, data: bytes, timeout_s: float) -> None:
        """Hand over a frame, waiting for room at most ``timeout_s``."""
        ...

    def wait(self, timeout_s: float) -> bool:
        """Sleep until something can be received; False when nothing came in time."""
        ...


class MessageLink:
    """Any bus of python-can, message by message.

    Error frames are read on the embedded bus, which carries SocketCAN's; every
    other interface has a language of its own for them, so they are only counted.
    """

    def __init__(self, bus: can.BusABC, counters: PortCounters, health: BusHealth) -> None:
        self._bus = bus
        self._counters = counters
        self._health = health
        self._reads_error_frames = isinstance(bus, EmbeddedBus)
        self._stamp_ns = stamping_of(bus)
        self._pending: can.Message | None = None
        try:
            self._fileno: int | None = bus.fileno()
        except NotImplementedError:
            self._fileno = None

    def drain(self, frames: list[Frame]) -> None:
        """Append what has come, oldest first."""
        for _ in range(DRAIN_LIMIT):
            message = self._next_message()
            if message is None:
                return
            if message.is_error_frame:
                self._read_error_frame(message)
            elif self._is_ours(message):
                self._health.heard()
                stamp_ns = self._stamp_ns(message)
                frames.append(Frame(message.arbitration_id, bytes(message.data), stamp_ns))

    def send(self, frame_id: int, data: bytes, timeout_s: float) -> None:
        """Send a frame with an 11-bit identifier."""
        message = can.Message(arbitration_id=frame_id, data=data, is_extended_id=False)
        self._bus.send(message, timeout=timeout_s)

    def wait(self, timeout_s: float) -> bool:
        """Sleep until something can be received; a bus that cannot be polled is read ahead."""
        if self._pending is not None:
            return True
        if self._fileno is None:
            self._pending = self._bus.recv(timeout=timeout_s)
            return self._pending is not None
        readable, _, _ = select.select([self._fileno], [], [], timeout_s)
        return bool(readable)

    def _next_message(self) -> can.Message | None:
        if self._pending is None:
            return self._bus.recv(timeout=0.0)
        message, self._pending = self._pending, None
        return message

    def _read_error_frame(self, message: can.Message) -> None:
        self._counters.error_frames += 1
        if self._reads_error_frames:
            self._health.error_frame(message.arbitration_id, bytes(message.data))

    def _is_ours(self, message: can.Message) -> bool:
        if message.is_remote_frame:
            self._counters.remote_frames += 1
        elif message.is_extended_id or message.is_fd:
            self._counters.dropped += 1
        else:
            self._counters.rx += 1
            return True
        return False
