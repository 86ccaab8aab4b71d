"""What the service has on every bus: an inbox, an eye on intruders, and its end of lockstep."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from tcs_hil.canbus.database import Database
from tcs_hil.canbus.inbox import Inbox, InboxCounters, Mailbox, Receiver
from tcs_hil.canbus.outbox import Outbox, OutgoingFrame
from tcs_hil.signals import BusCondition

HEALTHY: Final = BusCondition.OK
INTRUDER: Final = BusCondition.INTRUDER


class ServiceNode:
    """Base of the service's nodes; ``database`` is ours, which has the two lockstep frames."""

    def __init__(
        self, database: Database, mailboxes: Iterable[Receiver], own_ids: Iterable[int]
    ) -> None:
        self._bench = Mailbox(database.messages["BenchTick"], (0,))
        self._bench_done = Outbox(database.messages["BenchTickDone"])
        # The car's own messages win, should it use the identifier of the bench.
        self._inbox = Inbox([self._bench, *mailboxes], own_ids)
        self._own_ids_heard = 0

    @property
    def counters(self) -> InboxCounters:
        """What became of the frames fed so far."""
        return self._inbox.counters

    @property
    def bench_tick(self) -> int | None:
        """Newest lockstep tick the bench has completed, None before the first."""
        return None if self._bench.stamp_ns is None else int(self._bench.values[0])

    def feed(self, frame_id: int, data: bytes, stamp_ns: int) -> bool:
        """Take one frame; True if it was good and its values are now the newest."""
        return self._inbox.feed(frame_id, data, stamp_ns)

    def bench_tick_done(self, tick: int) -> OutgoingFrame:
        """Tell the bench, in lockstep, that everything of this tick has been sent."""
        return self._bench_done.frame(tick)

    def _intrusion(self) -> BusCondition:
        """Whether an identifier of ours was heard from somebody else since the last call."""
        heard, self._own_ids_heard = self._own_ids_heard, self.counters.own_id
        return INTRUDER if self._own_ids_heard > heard else HEALTHY
