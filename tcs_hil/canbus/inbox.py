"""Receiving half of a node: frames in, newest good values out.  Pure."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

from tcs_hil.canbus.database import MessageSpec
from tcs_hil.canbus.e2e import ERROR, OK, REPEATED, Checker, E2EStatus
from tcs_hil.canbus.watch import MessageWatch
from tcs_hil.signals import InputState


@dataclass(slots=True)
class InboxCounters:
    """What became of every frame fed so far."""

    good: int = 0
    unknown_id: int = 0
    wrong_length: int = 0
    e2e_error: int = 0
    repeated: int = 0
    wrong_sequence: int = 0
    own_id: int = 0


class Receiver(Protocol):
    """What an inbox sorts frames into."""

    frame_id: int
    length: int

    def put(self, data: bytes, stamp_ns: int) -> E2EStatus:
        """Judge a frame of the right length and keep its values when they are good."""
        ...

    def reject(self, stamp_ns: int) -> None:
        """Take note of a frame of the wrong length."""
        ...


class Mailbox:
    """Newest good values of one message, in the contract's order, and their stamp.

    ``stamp_ns`` is None until the first good frame; until then ``values`` are
    those the caller chose.
    """

    __slots__ = ("_checker", "_decode", "frame_id", "length", "stamp_ns", "values")

    def __init__(self, spec: MessageSpec, initial: tuple[float, ...]) -> None:
        self.frame_id = spec.frame_id
        self.length = spec.length
        self.values = initial
        self.stamp_ns: int | None = None
        self._decode = spec.codec.decode
        self._checker = Checker(spec.e2e) if spec.e2e is not None else None

    def put(self, data: bytes, stamp_ns: int) -> E2EStatus:
        """Judge a frame of the right length and keep its values when they are good."""
        status = self._checker.check(data) if self._checker is not None else OK
        if status is OK:
            self.values = self._decode(data)
            self.stamp_ns = stamp_ns
        return status

    def reject(self, stamp_ns: int) -> None:
        """Take note of a frame of the wrong length."""

    def age_s(self, now_ns: int) -> float:
        """Time since the newest good frame; infinite before the first, never negative."""
        if self.stamp_ns is None:
            return math.inf
        return max(now_ns - self.stamp_ns, 0) * 1e-9


class WatchedMailbox(Mailbox):
    """Mailbox of a cyclic message that also knows what state its protection has come to."""

    __slots__ = ("_watch",)

    def __init__(self, spec: MessageSpec, initial: tuple[float, ...]) -> None:
        super().__init__(spec, initial)
        self._watch = MessageWatch(spec.window, spec.cycle_ns)

    def put(self, data: bytes, stamp_ns: int) -> E2EStatus:
        """Judge a frame as every mailbox does, and count it."""
        status = super().put(data, stamp_ns)
        self._watch.count(status, stamp_ns)
        return status

    def reject(self, stamp_ns: int) -> None:
        """Count a frame of the wrong length as an error."""
        self._watch.count(ERROR, stamp_ns)

    def state(self, now_ns: int) -> InputState:
        """What the protection has come to by ``now_ns``."""
        return self._watch.state(now_ns)


class Inbox:
    """Sorts frames into the mailboxes of a node and counts what does not fit.

    ``own_ids`` are those only this node may send: from anyone else they are
    counted apart.
    """

    def __init__(self, mailboxes: Iterable[Receiver], own_ids: Iterable[int]) -> None:
        self.counters = InboxCounters()
        self._mailboxes = {mailbox.frame_id: mailbox for mailbox in mailboxes}
        self._own_ids = frozenset(own_ids)

    def feed(self, frame_id: int, data: bytes, stamp_ns: int) -> bool:
        """Take one frame; True if it was good and its values are now the newest."""
        mailbox = self._mailboxes.get(frame_id)
        if mailbox is None:
            self._count_stranger(frame_id)
            return False
        if len(data) != mailbox.length:
            self.counters.wrong_length += 1
            mailbox.reject(stamp_ns)
            return False
        status = mailbox.put(data, stamp_ns)
        self._count(status)
        return status is OK

    def _count_stranger(self, frame_id: int) -> None:
        if frame_id in self._own_ids:
            self.counters.own_id += 1
        else:
            self.counters.unknown_id += 1

    def _count(self, status: E2EStatus) -> None:
        if status is OK:
            self.counters.good += 1
        elif status is ERROR:
            self.counters.e2e_error += 1
        elif status is REPEATED:
            self.counters.repeated += 1
        else:
            self.counters.wrong_sequence += 1
