"""How old the speed is that a toothed wheel shows."""

from __future__ import annotations

import math
from typing import Final

OLDEST_S: Final = 0.05
"""No speed is brought up to date by more: the acceleration now says little of so long ago."""


class EdgeAge:
    """Seconds since the wheel had the speed it shows: the mean between its last two edges.

    The bus does not say how many teeth there are; how long values stand does.
    """

    def __init__(self, period_s: float) -> None:
        self._period_s = period_s
        self._seen_radps = math.nan
        self._stood_s = self._gap_s = 0.0

    def update(self, speed_radps: float) -> float:
        """Age of ``speed_radps``; called once a tick."""
        if speed_radps == self._seen_radps:
            self._stood_s += self._period_s
        else:
            self._gap_s = self._stood_s + self._period_s
            self._seen_radps, self._stood_s = speed_radps, 0.0
        return min(self._stood_s + 0.5 * self._gap_s, OLDEST_S)
