"""Counters that grow by one with each frame, in one signal or split over several."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import accumulate

from tcs_hil.canbus.codec import SignalSpec
from tcs_hil.canbus.e2e import E2EStatus


@dataclass(frozen=True, slots=True)
class Counter:
    """A counter from 0 to ``highest``; ``parts`` are its raw signals, lowest bits first."""

    parts: tuple[SignalSpec, ...]
    highest: int
    max_step: int

    def split(self, count: int) -> list[int]:
        """Raw values of the parts."""
        values = []
        for part in self.parts:
            values.append(count & part.mask)
            count >>= part.length
        return values

    def weights(self) -> tuple[int, ...]:
        """What one step of each part counts."""
        shifts = accumulate((part.length for part in self.parts[:-1]), initial=0)
        return tuple(1 << shift for shift in shifts)


class Succession:
    """Judges whether each count follows the one before.

    A count above ``highest`` is none: whoever sends it is not who we think.
    """

    __slots__ = ("_highest", "_last", "_max_step")

    def __init__(self, highest: int, max_step: int) -> None:
        self._highest = highest
        self._max_step = max_step
        self._last: int | None = None

    def judge(self, count: int) -> E2EStatus:
        """Compare with the newest count, and take this one over even where it is refused."""
        if count > self._highest:
            return E2EStatus.ERROR
        last, self._last = self._last, count
        if last is None:
            return E2EStatus.OK
        step = (count - last) % (self._highest + 1)
        if step == 0:
            return E2EStatus.REPEATED
        return E2EStatus.OK if step <= self._max_step else E2EStatus.WRONG_SEQUENCE
