"""Counting the turns of a signal that swings, and averaging over its swings."""

from __future__ import annotations

import math
from collections import deque
from typing import Final

SLOWEST_SWING_S: Final = 0.25
"""A loop that swings slower than at 2 Hz is only slow."""
LASTING_RATIO: Final = 0.9
"""A swing smaller than this share of the one a period before dies away."""


class Swings:
    """Counts the turning points of an unbroken row of swings, each of at most 0.25 s.

    Swings that die away by themselves do not count, but do not break the row.

    A signal has turned once it has come back from its extreme by ``least``, so
    smaller ripple neither counts nor hides a swing.
    """

    def __init__(self, period_s: float) -> None:
        self._period_s = period_s
        self._direction = 1.0
        self._extreme = self._turned_at = math.nan
        self._sizes = (0.0, 0.0)  # of the last two swings, the newest last
        self._age_s = 0.0  # since the last turning point
        self._since_s = 0.0  # since the extreme, perhaps the next turning point
        self.turns = 0

    def update(self, value: float, least: float) -> bool:
        """Hear the value of one tick; True if it shows that the signal has turned."""
        self._age_s += self._period_s
        back = self._direction * (self._extreme - value)
        if not back >= 0.0:  # farther out; or the first value, after NaN
            self._extreme, self._since_s = value, 0.0
            return False
        self._since_s += self._period_s
        if back >= least:
            self._turn(value)
            return True
        if self._age_s > 2.0 * SLOWEST_SWING_S:  # even a swing that began at once was too slow
            self.turns = 0
        return False

    def reset(self) -> None:
        """No swing has been seen."""
        self.turns = 0
        self._direction, self._sizes = 1.0, (0.0, 0.0)
        self._extreme = self._turned_at = math.nan
        self._age_s = self._since_s = 0.0

    def _turn(self, value: float) -> None:
        size = abs(self._extreme - self._turned_at)
        fast = self._age_s - self._since_s <= SLOWEST_SWING_S
        dies = size < LASTING_RATIO * self._sizes[0]
        if not (fast and dies):
            self.turns = self.turns + 1 if fast else 1
        self._sizes = (self._sizes[1], size)
        self._turned_at = self._extreme
        self._age_s, self._since_s = self._since_s, 0.0
        self._direction, self._extreme = -self._direction, value


class SwingMean:
    """Mean of a signal over its last two whole swings: over one period."""

    def __init__(self) -> None:
        self.reset()

    def add(self, value: float, *, turned: bool) -> None:
        """Hear the value of one tick, and whether a swing has ended with it."""
        if turned:
            self._swings.append((0.0, 0))
        total, ticks = self._swings[-1]
        self._swings[-1] = total + value, ticks + 1

    @property
    def value(self) -> float:
        """The mean, as far as swings are known; 0 before the first has ended."""
        whole = list(self._swings)[:-1]
        return sum(total for total, _ in whole) / max(sum(ticks for _, ticks in whole), 1)

    def reset(self) -> None:
        """Nothing was heard."""
        self._swings = deque([(0.0, 0)], maxlen=3)  # sum, ticks; the last is under way
