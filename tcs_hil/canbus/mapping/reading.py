"""Newest value of one mapped quantity."""

from __future__ import annotations

import math


class Reading:
    """A value in the service's unit, whether its sender vouches for it, and its stamp.

    With ``keeps_doubtful`` a value nobody vouches for replaces the one before and
    says so; else it is as if it had not come, and the one before grows old.
    """

    __slots__ = ("_keeps_doubtful", "stamp_ns", "valid", "value")

    def __init__(self, *, keeps_doubtful: bool) -> None:
        self._keeps_doubtful = keeps_doubtful
        self.value = 0.0
        self.valid = False
        self.stamp_ns: int | None = None

    def take(self, value: float, valid: bool, stamp_ns: int) -> None:
        """Take a decoded value over."""
        self.valid = valid
        if valid or self._keeps_doubtful:
            self.value = value
            self.stamp_ns = stamp_ns

    def age_s(self, now_ns: int) -> float:
        """Time since the newest value; infinite before the first, never negative."""
        if self.stamp_ns is None:
            return math.inf
        return max(now_ns - self.stamp_ns, 0) * 1e-9
