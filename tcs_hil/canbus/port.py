"""A python-can bus as the tick uses it: it never raises, and stamps on one time base."""

from __future__ import annotations

import errno
import select
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import can

from tcs_hil.canbus.bus import choose_interface, open_bus
from tcs_hil.canbus.stamps import stamps_for
from tcs_hil.errors import BusError

DRAIN_LIMIT = 256
"""Frames taken at once: a babbling node must not keep the tick from its work."""
REOPEN_INTERVAL_NS = 100_000_000

_UNUSABLE = frozenset({errno.ENODEV, errno.ENXIO, errno.EBADF})
"""The interface was removed; a socket does not find its successor by itself."""


class Frame(NamedTuple):
    """A classic data frame and when it came, on CLOCK_MONOTONIC."""

    frame_id: int
    data: bytes
    stamp_ns: int


@dataclass(slots=True)
class PortCounters:
    """Everything the port has met; errors are counted here and raised nowhere.

    ``dropped`` are frames nobody here speaks: extended identifiers and CAN FD.
    """

    rx: int = 0
    tx: int = 0
    error_frames: int = 0
    remote_frames: int = 0
    dropped: int = 0
    rx_errors: int = 0
    tx_errors: int = 0
    reopened: int = 0


def open_port(
    interface: str = "auto",
    channel: str = "vcan0",
    bitrate: int | None = None,
    *,
    send_timeout_s: float = 0.0,
) -> tuple[CanPort, str]:
    """Open a port as ``open_bus`` opens a bus; it finds its interface again after a removal.

    What ``auto`` chose stays chosen: a port never moves to another kind of bus.

    Raises:
        BusError: The interface is unknown, missing or cannot be opened.
    """
    chosen, description = choose_interface(interface, channel)

    def open_chosen() -> can.BusABC:
        return open_bus(chosen, channel, bitrate)[0]

    port = CanPort(open_chosen(), reopen=open_chosen, send_timeout_s=send_timeout_s)
    return port, description


class CanPort:
    """Sends and receives on a bus, which it owns.

    ``reopen`` makes a new bus once the interface was removed; without it the
    port goes on counting errors.  ``send_timeout_s`` is how long a full bus is
    waited for: not at all in real time, where the next tick matters more.
    """

    def __init__(
        self,
        bus: can.BusABC,
        *,
        reopen: Callable[[], can.BusABC] | None = None,
        send_timeout_s: float = 0.0,
    ) -> None:
        self.counters = PortCounters()
        self._reopen = reopen
        self._send_timeout_s = send_timeout_s
        self._reopen_at_ns: int | None = None
        self._pending: can.Message | None = None
        self._use(bus)

    def receive(self) -> list[Frame]:
        """Take what has come, oldest first, without waiting."""
        if self._reopen_at_ns is not None:
            self._recover()
        self._stamps.begin()
        frames: list[Frame] = []
        for _ in range(DRAIN_LIMIT):
            message = self._next_message()
            if message is None:
                self._stamps.end()
                break
            if self._is_ours(message):
                stamp_ns = self._stamps.stamp_ns(message)
                frames.append(Frame(message.arbitration_id, bytes(message.data), stamp_ns))
        return frames

    def send(self, frame_id: int, data: bytes) -> bool:
        """Send a frame with an 11-bit identifier; False (and counted) if the bus refused."""
        message = can.Message(arbitration_id=frame_id, data=data, is_extended_id=False)
        try:
            self._bus.send(message, timeout=self._send_timeout_s)
        except (can.CanError, OSError) as error:
            self.counters.tx_errors += 1
            self._notice(error)
            return False
        self.counters.tx += 1
        return True

    def wait(self, timeout_s: float) -> bool:
        """Sleep until something can be received, at most ``timeout_s``; True if so."""
        if self._pending is not None:
            return True
        if self._fileno is None:
            self._pending = self._read(timeout_s)
            return self._pending is not None
        readable, _, _ = select.select([self._fileno], [], [], timeout_s)
        return bool(readable)

    def close(self) -> None:
        """Leave the bus."""
        self._bus.shutdown()

    def _use(self, bus: can.BusABC) -> None:
        self._bus = bus
        self._stamps = stamps_for(bus)
        self._pending = None
        try:
            self._fileno: int | None = bus.fileno()
        except NotImplementedError:
            self._fileno = None

    def _next_message(self) -> can.Message | None:
        if self._pending is None:
            return self._read(0.0)
        message, self._pending = self._pending, None
        return message

    def _read(self, timeout_s: float) -> can.Message | None:
        try:
            return self._bus.recv(timeout=timeout_s)
        except (can.CanError, OSError) as error:
            self.counters.rx_errors += 1
            self._notice(error)
            return None

    def _is_ours(self, message: can.Message) -> bool:
        if message.is_error_frame:
            self.counters.error_frames += 1
        elif message.is_remote_frame:
            self.counters.remote_frames += 1
        elif message.is_extended_id or message.is_fd:
            self.counters.dropped += 1
        else:
            self.counters.rx += 1
            return True
        return False

    def _notice(self, error: can.CanError | OSError) -> None:
        code = error.error_code if isinstance(error, can.CanError) else error.errno
        # A mere ENETDOWN heals by itself: the socket works again once the interface is up.
        if code in _UNUSABLE and self._reopen_at_ns is None:
            self._reopen_at_ns = time.monotonic_ns()

    def _recover(self) -> None:
        now_ns = time.monotonic_ns()
        if self._reopen is None or self._reopen_at_ns is None or now_ns < self._reopen_at_ns:
            return
        try:
            bus = self._reopen()
        except BusError:
            self._reopen_at_ns = now_ns + REOPEN_INTERVAL_NS
            return
        self._bus.shutdown()
        self._use(bus)
        self._reopen_at_ns = None
        self.counters.reopened += 1
