"""The bus vcan has not: frames take time, wait for each other and get lost.

A simulation of one classic CAN segment: frames queue at their nodes, the lowest
identifier wins whenever the bus is free, every bit takes its time.  A node's
controller has one mailbox per identifier: a frame that still waits when the next
one with its identifier is queued is never sent.
"""

from __future__ import annotations

import heapq
import math
from collections import deque
from enum import IntEnum

import numpy as np

from plant_emulator.bustiming import BusTiming
from plant_emulator.frame_bits import frame_bits

STRANGER_BITS = 120
"""Mean length of a foreign frame of eight random bytes, stuff bits included."""


class Sender(IntEnum):
    """Whose frame it is."""

    VEHICLE = 0
    SERVICE = 1
    STRANGER = 2


class BusFrame:
    """A frame on its way.  ``order`` is that of offering; a sender has mailboxes per identifier."""

    __slots__ = ("data", "frame_id", "mailbox", "order", "sender")

    def __init__(
        self, frame_id: int, order: int, data: bytes, sender: Sender, mailbox: int
    ) -> None:
        self.frame_id = frame_id
        self.order = order
        self.data = data
        self.sender = sender
        self.mailbox = mailbox

    def wins_over(self, other: BusFrame) -> bool:
        """Whether it comes through when both start at once; of equals the older one."""
        if self.frame_id != other.frame_id:
            return self.frame_id < other.frame_id
        return self.order < other.order

    def replaces(self, other: BusFrame) -> bool:
        """Whether it takes the place of ``other``, which still waits: a mailbox holds one frame."""
        return (
            self.frame_id == other.frame_id
            and self.sender is other.sender
            and self.mailbox == other.mailbox
        )


class Delivery:
    """A frame at the end of its last bit."""

    __slots__ = ("frame", "time_ns")

    def __init__(self, time_ns: int, frame: BusFrame) -> None:
        self.time_ns = time_ns
        self.frame = frame


class VirtualBus:
    """Orders frames in time.  Pure: times are arguments, in nanoseconds from the start."""

    def __init__(self, timing: BusTiming) -> None:
        self._timing = timing
        # Two streams: how time is cut must not change what is drawn.
        self._strangers = np.random.default_rng([timing.seed, 0])
        self._losses = np.random.default_rng([timing.seed, 1])
        self._bit_ns = 1e9 / timing.bitrate if timing.bitrate else 0.0
        self._order = 0
        self._queued: list[tuple[int, int, BusFrame]] = []  # heap: when, order, what is offered
        self._ready: list[BusFrame] = []  # want to be sent next, one to a mailbox
        self._sent: deque[Delivery] = deque()
        self._free_ns = 0
        self._now_ns = 0
        self._stranger_ns = self._next_stranger(0.0)
        frame_bits(0, b"")  # compiles it now and not in the first tick

    def offer(
        self, time_ns: int, frame_id: int, data: bytes, sender: Sender, mailbox: int = 0
    ) -> None:
        """Queue a frame at its node; a time that has passed counts as now.

        It takes the place of one that still waits in the same mailbox.
        """
        self._order += 1
        frame = BusFrame(frame_id, self._order, data, sender, mailbox)
        heapq.heappush(self._queued, (max(time_ns, self._now_ns), self._order, frame))

    def run_until(self, now_ns: int) -> list[Delivery]:
        """Carry the bus on to ``now_ns``; returns what arrived since the last call, in order."""
        self._offer_strangers(now_ns)
        self._now_ns = max(now_ns, self._now_ns)
        while (start_ns := self._next_start()) is not None and start_ns <= self._now_ns:
            self._transmit(start_ns)
        arrived = []
        while self._sent and self._sent[0].time_ns <= self._now_ns:
            delivery = self._sent.popleft()
            if self._reaches_us(delivery.frame):
                arrived.append(delivery)
        return arrived

    @property
    def next_arrival_ns(self) -> int | None:
        """End of the frame that is on the wire, None if there is none."""
        return self._sent[0].time_ns if self._sent else None

    def _next_start(self) -> int | None:
        """When the bus is free and somebody has a frame for it."""
        if self._ready:
            return self._free_ns
        return max(self._free_ns, self._queued[0][0]) if self._queued else None

    def _transmit(self, start_ns: int) -> None:
        """Let everybody who is there at ``start_ns`` arbitrate, and the winner send."""
        while self._queued and self._queued[0][0] <= start_ns:
            self._make_ready(heapq.heappop(self._queued)[2])
        winner = self._ready[0]
        for frame in self._ready:
            if frame.wins_over(winner):
                winner = frame
        self._ready.remove(winner)
        bits = frame_bits(winner.frame_id, winner.data) if self._bit_ns else 0
        self._free_ns = start_ns + round(bits * self._bit_ns)
        self._sent.append(Delivery(self._free_ns, winner))

    def _make_ready(self, frame: BusFrame) -> None:
        self._ready = [waiting for waiting in self._ready if not frame.replaces(waiting)]
        self._ready.append(frame)

    def _offer_strangers(self, until_ns: int) -> None:
        while self._stranger_ns <= until_ns:
            frame_id = int(self._strangers.integers(0x800))
            self.offer(int(self._stranger_ns), frame_id, self._strangers.bytes(8), Sender.STRANGER)
            self._stranger_ns = self._next_stranger(self._stranger_ns)

    def _next_stranger(self, after_ns: float) -> float:
        load = self._timing.background_load
        if load == 0.0 or self._bit_ns == 0.0:
            return math.inf
        return after_ns + self._strangers.exponential(STRANGER_BITS * self._bit_ns / load)

    def _reaches_us(self, frame: BusFrame) -> bool:
        if frame.sender is Sender.STRANGER:
            return False
        ratio = self._timing.loss_ratio
        return ratio == 0.0 or bool(self._losses.random() >= ratio)
