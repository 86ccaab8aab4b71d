"""One tick of the loop: when it was, what it brought, and what its makers know of it."""

from __future__ import annotations

import msgspec

from tcs_hil.canbus.inbox import InboxCounters
from tcs_hil.canbus.port import PortCounters
from tcs_hil.signals import Command, Measurement
from tcs_hil.trace import Trace


class Tick(msgspec.Struct, frozen=True):
    """One pass of the loop; all times in ns.

    ``now_ns`` is the time decisions are made with: the bench's clock in
    lockstep, else ``wake_ns``.  The other times are CLOCK_MONOTONIC.  ``number``
    counts periods since the start, so ``skipped`` ones leave a gap.
    """

    number: int
    scheduled_ns: int
    wake_ns: int
    now_ns: int
    deadline_ns: int
    skipped: int


class Stamps(msgspec.Struct, frozen=True):
    """When each stage of a tick was finished, CLOCK_MONOTONIC."""

    received_ns: int
    stepped_ns: int
    sent_ns: int


class Pass(msgspec.Struct, frozen=True):
    """One tick, made."""

    tick: Tick
    stamps: Stamps
    frames: int
    measurement: Measurement
    command: Command
    failed: bool  # the pipeline raised
    overrun: bool  # sent after the deadline


class Insight(msgspec.Struct, frozen=True):
    """What the parts of the service know about the tick just made."""

    trace: Trace
    solve_ns: tuple[int, int]
    wheel_stamp_ns: int | None
    counters: PortCounters
    inbox: InboxCounters
