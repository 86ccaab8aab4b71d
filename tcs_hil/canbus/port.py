"""A CAN bus as the tick uses it: it never raises, and stamps on one time base."""

from __future__ import annotations

import errno
import time
from collections.abc import Callable

import can
from can.interfaces.socketcan import SocketcanBus

from tcs_hil.canbus.bus import choose_interface, open_bus
from tcs_hil.canbus.frame import Frame, PortCounters
from tcs_hil.canbus.health import BusHealth
from tcs_hil.canbus.link import DRAIN_LIMIT, Link, MessageLink
from tcs_hil.canbus.socket_link import SocketLink
from tcs_hil.errors import BusError
from tcs_hil.signals import BusCondition

__all__ = ["DRAIN_LIMIT", "CanPort", "Frame", "PortCounters", "open_port"]

REOPEN_INTERVAL_NS = 100_000_000

_GONE = frozenset({errno.ENODEV, errno.ENXIO, errno.EBADF})
"""The interface was removed; a socket does not find its successor by itself."""


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
    """Sends and receives on a bus, which it owns: nobody else may read from it.

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
        self._health = BusHealth()
        self._reopen = reopen
        self._send_timeout_s = send_timeout_s
        self._reopen_at_ns: int | None = None
        self._use(bus)

    def receive(self) -> list[Frame]:
        """Take what has come, oldest first, without waiting."""
        self._recover()
        frames: list[Frame] = []
        try:
            self._link.drain(frames)
        except (can.CanError, OSError) as error:
            self._count_receive_error(error)
        return frames

    def send(self, frame_id: int, data: bytes) -> bool:
        """Send a frame with an 11-bit identifier; False (and counted) if the bus refused."""
        try:
            self._link.send(frame_id, data, self._send_timeout_s)
        except (can.CanError, OSError) as error:
            self.counters.tx_errors += 1
            self._health.send_failed()
            self._notice(error)
            return False
        self.counters.tx += 1
        self._health.sent()
        return True

    def wait(self, timeout_s: float) -> bool:
        """Sleep until something can be received, at most ``timeout_s``; True if so."""
        self._recover()
        try:
            return self._link.wait(timeout_s)
        except (can.CanError, OSError) as error:
            self._count_receive_error(error)
            return False

    def condition(self) -> BusCondition:
        """Worst that the bus has shown since the last call; what lasts is said again."""
        return self._health.condition()

    def close(self) -> None:
        """Leave the bus."""
        self._bus.shutdown()

    def _use(self, bus: can.BusABC) -> None:
        self._bus = bus
        self._link = _link_to(bus, self.counters, self._health)

    def _count_receive_error(self, error: can.CanError | OSError) -> None:
        self.counters.rx_errors += 1
        self._notice(error)

    def _notice(self, error: can.CanError | OSError) -> None:
        code = error.error_code if isinstance(error, can.CanError) else error.errno
        if code == errno.ENETDOWN or code in _GONE:
            self._health.link_lost()
        # A mere ENETDOWN heals by itself: the socket works again once the interface is up.
        if code in _GONE and self._reopen_at_ns is None:
            self._reopen_at_ns = time.monotonic_ns()

    def _recover(self) -> None:
        if self._reopen_at_ns is None or self._reopen is None:
            return
        now_ns = time.monotonic_ns()
        if now_ns < self._reopen_at_ns:
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


def _link_to(bus: can.BusABC, counters: PortCounters, health: BusHealth) -> Link:
    if isinstance(bus, SocketcanBus):
        return SocketLink(bus.socket, counters, health)
    return MessageLink(bus, counters, health)
