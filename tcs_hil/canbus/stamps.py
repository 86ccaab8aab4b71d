"""Receive stamps of every kind of bus on one time base: CLOCK_MONOTONIC in ns.

What ``can.Message.timestamp`` means depends on the interface.  SocketCAN stamps
with CLOCK_REALTIME, which may step; the embedded bus with CLOCK_MONOTONIC; of
any other interface nothing is assumed and the moment of reading is taken.
"""

from __future__ import annotations

import time
from typing import Protocol

import can
from can.interfaces.socketcan import SocketcanBus

from tcs_hil.canbus.embedded import EmbeddedBus


class Stamps(Protocol):
    """Time base of one bus; ``stamp_ns`` may be asked between ``begin`` and ``end``."""

    def begin(self) -> None:
        """A drain of the bus starts."""

    def stamp_ns(self, message: can.Message) -> int:
        """When the message came, on CLOCK_MONOTONIC."""
        ...

    def end(self) -> None:
        """The drain has left the bus empty."""


class MonotonicStamps:
    """Messages that carry CLOCK_MONOTONIC already."""

    def begin(self) -> None:
        """Nothing to measure."""

    def stamp_ns(self, message: can.Message) -> int:
        """Take the stamp as it is."""
        return round(message.timestamp * 1e9)

    def end(self) -> None:
        """Nothing to remember."""


class ReadTimeStamps(MonotonicStamps):
    """Messages whose stamps mean nothing known: the moment of reading counts."""

    def stamp_ns(self, message: can.Message) -> int:  # noqa: ARG002
        """Take the time of this very call."""
        return time.monotonic_ns()


class RealtimeStamps:
    """Messages stamped with CLOCK_REALTIME, moved over by the offset of each drain.

    A frame cannot have come before the previous drain, which left the bus empty,
    nor after now.  Holding the stamps to that keeps them right to within one
    tick when somebody steps the wall clock between arrival and drain.  python-can
    hands the stamp over as a float, which resolves about 0.25 µs.
    """

    def __init__(self) -> None:
        self._offset_ns = 0
        self._earliest_ns = 0
        self._begin_ns = 0

    def begin(self) -> None:
        """Measure the offset between the clocks."""
        self._begin_ns = time.monotonic_ns()
        self._offset_ns = self._begin_ns - time.time_ns()

    def stamp_ns(self, message: can.Message) -> int:
        """Move the stamp over and hold it to what is possible."""
        moved_ns = round(message.timestamp * 1e9) + self._offset_ns
        return min(max(moved_ns, self._earliest_ns), time.monotonic_ns())

    def end(self) -> None:
        """Remember since when the bus has been empty."""
        self._earliest_ns = self._begin_ns


def stamps_for(bus: can.BusABC) -> Stamps:
    """Time base of a bus, by its kind."""
    if isinstance(bus, SocketcanBus):
        return RealtimeStamps()
    return MonotonicStamps() if isinstance(bus, EmbeddedBus) else ReadTimeStamps()
