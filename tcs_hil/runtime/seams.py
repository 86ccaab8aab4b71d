"""What the loop needs of the bus and of the control code, and nothing more."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from tcs_hil.canbus.inbox import InboxCounters
from tcs_hil.canbus.port import Frame, PortCounters
from tcs_hil.signals import BusCondition, Command, Measurement
from tcs_hil.trace import Trace


class Port(Protocol):
    """An open CAN channel.  Bad frames and failed sends are counted, never raised."""

    @property
    def counters(self) -> PortCounters:
        """What the port has seen since it was opened."""
        ...

    def receive(self) -> list[Frame]:
        """Return every frame waiting, oldest first, without blocking."""
        ...

    def send(self, frame_id: int, data: bytes) -> bool:
        """Queue one frame; False and counted when the bus does not take it."""
        ...

    def wait(self, timeout_s: float) -> bool:
        """Sleep until a frame is waiting; False when none came in time."""
        ...

    def condition(self) -> BusCondition:
        """Return the worst that the bus itself has shown since the last call."""
        ...


class Bench(Protocol):
    """The lockstep frames of the DBC."""

    @property
    def bench_tick(self) -> int | None:
        """Newest tick the bench has announced, None before the first."""
        ...

    def feed(self, frame_id: int, data: bytes, stamp_ns: int) -> bool:
        """Take one received frame in; False and counted when it is no good."""
        ...

    def bench_tick_done(self, tick: int) -> tuple[int, bytes]:
        """Return the frame that answers ``tick``."""
        ...


class Node(Bench, Protocol):
    """The service's end of the DBC: frames to signals and back."""

    @property
    def counters(self) -> InboxCounters:
        """What became of the frames fed so far."""
        ...

    @property
    def newest_wheel_stamp_ns(self) -> int | None:
        """Stamp of the newest good wheel-speed frame, None before the first."""
        ...

    def measurement(self, now_ns: int, bus: BusCondition) -> Measurement:
        """Return the newest value of every input, aged to ``now_ns``, and the bus's condition."""
        ...

    def frames(
        self, command: Command, now_ns: int, tick_overruns: int
    ) -> Sequence[tuple[int, bytes]]:
        """Return the frames that are due with this command."""
        ...


class Pipeline(Protocol):
    """The control code between measurement and command."""

    @property
    def trace(self) -> Trace | None:
        """What the newest tick thought, None before the first."""
        ...

    def step(self, measurement: Measurement) -> Command:
        """Decide one tick."""
        ...

    def sent(self, overran: bool) -> None:
        """Hear, after the tick, whether its limits went out after the deadline."""
        ...

    def abandon(self, measurement: Measurement) -> Command:
        """Decide one tick after ``step`` broke: FAULT, torque back to the driver."""
        ...
