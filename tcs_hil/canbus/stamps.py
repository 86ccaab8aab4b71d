"""Receive stamps of every kind of bus on one time base: CLOCK_MONOTONIC in ns.

What a stamp means depends on the interface.  SocketCAN stamps with
CLOCK_REALTIME, which may step; the embedded bus with CLOCK_MONOTONIC; of any
other interface nothing is assumed and the moment of reading is taken.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import can

from tcs_hil.canbus.embedded import EmbeddedBus


def stamping_of(bus: can.BusABC) -> Callable[[can.Message], int]:
    """What turns a message of ``bus``, read this moment, into its stamp in ns."""
    return _monotonic_ns if isinstance(bus, EmbeddedBus) else _read_time_ns


def _monotonic_ns(message: can.Message) -> int:
    return round(message.timestamp * 1e9)


def _read_time_ns(_message: can.Message) -> int:
    return time.monotonic_ns()


class RealtimeStamps:
    """Stamps of CLOCK_REALTIME, moved over by the offset that each drain of the bus measures.

    A frame cannot have come before the previous drain, which left the bus empty,
    nor after now.  Holding the stamps to that keeps them right to within one
    tick when somebody steps the wall clock between arrival and drain.
    """

    def __init__(self) -> None:
        self._offset_ns = 0
        self._earliest_ns = 0
        self._begin_ns = 0

    def begin(self) -> None:
        """A drain starts: measure the offset between the clocks."""
        self._begin_ns = time.monotonic_ns()
        self._offset_ns = self._begin_ns - time.time_ns()

    def moved_ns(self, realtime_ns: int) -> int:
        """Move a stamp over to CLOCK_MONOTONIC and hold it to what is possible."""
        moved_ns = realtime_ns + self._offset_ns
        return min(max(moved_ns, self._earliest_ns), time.monotonic_ns())

    def end(self) -> None:
        """The drain has left the bus empty: remember since when."""
        self._earliest_ns = self._begin_ns
