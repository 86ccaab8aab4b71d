"""Counters that grow by one with each frame, in one signal or split over several."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

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

    def join(self, values: Sequence[float]) -> int:
        """Count that these raw values of the parts make up."""
        count, shift = 0, 0
        for part, value in zip(self.parts, values, strict=True):
            count |= int(value) << shift
            shift += part.length
        return count


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
