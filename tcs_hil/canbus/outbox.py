"""Sending half of a node: values in, protected frames out, each on its cycle.  Pure."""

from __future__ import annotations

from typing import Final, TypeAlias

from tcs_hil.canbus.database import MessageSpec
from tcs_hil.canbus.e2e import Protector

OutgoingFrame: TypeAlias = tuple[int, bytes]
"""Identifier and payload, ready for ``CanPort.send``."""

EARLY_NS: Final = 500_000
"""A frame may leave this much before it is due: the wake-up jitter of its sender
must not turn a cycle of 2 ms into one of 4 ms."""


class Cycle:
    """Says once per ``cycle_ns`` that it is time to send; the first time at once.

    Whoever comes late by a whole cycle or more gets one frame, not a burst.
    """

    __slots__ = ("_cycle_ns", "_due_ns")

    def __init__(self, cycle_ns: int) -> None:
        self._cycle_ns = cycle_ns
        self._due_ns: int | None = None

    def is_due(self, now_ns: int) -> bool:
        """Whether to send now; a yes is the start of the next cycle."""
        if self._due_ns is not None and now_ns < self._due_ns - EARLY_NS:
            return False
        due_ns = now_ns if self._due_ns is None else self._due_ns
        late = now_ns - due_ns >= self._cycle_ns
        self._due_ns = (now_ns if late else due_ns) + self._cycle_ns
        return True


class Outbox:
    """One message on its way out: encodes, counts and signs, and knows when it is due."""

    __slots__ = ("_cycle", "_encode", "_frame_id", "_protector")

    def __init__(self, spec: MessageSpec) -> None:
        self._frame_id = spec.frame_id
        self._cycle = Cycle(spec.cycle_ns)
        self._encode = spec.codec.encode
        self._protector = Protector(spec.e2e) if spec.e2e is not None else None

    def frame(self, *values: float) -> OutgoingFrame:
        """Encode the values (contract's order) with the next counter and the CRC."""
        payload = self._encode(*values)
        if self._protector is not None:
            self._protector.protect(payload)
        return self._frame_id, bytes(payload)

    def is_due(self, now_ns: int) -> bool:
        """Say once per cycle that the message is due; the first time at once."""
        return self._cycle.is_due(now_ns)
