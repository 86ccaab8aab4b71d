"""Cycles and frames of one message weighed against each other.  Pure: time is an argument.

Every cycle owes one frame.  Transport delays a frame by some cycles and then
delivers several at once; neither loses nor invents one.  So a cycle counts as
missed only once more than ``GRACE_CYCLES`` are owed, and a frame comes too often
only when none is.
"""

from __future__ import annotations

from typing import Final

GRACE_CYCLES: Final = 3
"""One on its way, and a delay that changes by as much as two cycles."""

LENIENT_START: Final = GRACE_CYCLES - 1
"""Owed after the first frame: it may itself have been late, and the next ones in a hurry."""


class Cadence:
    """Tells missed cycles and superfluous frames of a message with the cycle ``cycle_ns`` > 0."""

    __slots__ = ("_cycle_ns", "_owed", "_since_ns")

    def __init__(self, cycle_ns: int) -> None:
        self._cycle_ns = cycle_ns
        self._owed = 0
        self._since_ns: int | None = None  # start of the newest cycle

    def arrive(self, now_ns: int) -> bool:
        """Take note of a frame, once ``missed`` was asked at ``now_ns``; False if one too many."""
        if self._since_ns is None:
            self._begin(now_ns)
            return True
        if self._owed == 0:
            return False
        self._owed -= 1
        return True

    def missed(self, now_ns: int) -> int:
        """How many cycles have been given up since the last call; none before the first frame."""
        if self._since_ns is None:
            return 0
        cycles = (now_ns - self._since_ns) // self._cycle_ns
        if cycles < -GRACE_CYCLES:  # a bench that starts anew turns its clock back
            self._begin(now_ns)
        if cycles <= 0:
            return 0
        self._since_ns += cycles * self._cycle_ns
        self._owed += cycles
        missed = max(self._owed - GRACE_CYCLES, 0)
        self._owed -= missed
        return missed

    def _begin(self, now_ns: int) -> None:
        self._since_ns = now_ns
        self._owed = LENIENT_START
