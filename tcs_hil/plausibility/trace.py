"""How signals behave over time: for how long it has been so, what jumps, what stands still."""

from __future__ import annotations

import math
from typing import Final

EDGE_RATIO: Final = 0.06  # edges of a toothed ring that are off their place
EDGE_MPS: Final = 0.1
RING_M: Final = 0.2  # way in which every ring shows an edge
NEAR_RATIO: Final = 0.05  # of speeds that agree
NEAR_MPS: Final = 0.4


class Duration:
    """For how long something has been so; a moment in which it was not counts double."""

    def __init__(self, seconds: float, period_s: float) -> None:
        self._needed = round(seconds / period_s)
        self._ticks = 0

    def reached(self, holds: bool) -> bool:
        """Hear of one tick; whether it has been long enough."""
        if not holds:
            self._ticks = max(self._ticks - 2, 0) if self._ticks else 0
            return False
        if self._ticks < self._needed:
            self._ticks += 1
        return self._ticks == self._needed


class SpeedTrace:
    """One speed as it comes; NaN is none.

    ``change_mps``: from the speed before.  ``jumped``: no wheel gets there from it.
    """

    def __init__(self, rate_mps2: float, period_s: float) -> None:
        self.change_mps = math.nan
        self.jumped = False
        self._step_mps = rate_mps2 * period_s
        self._period_s = period_s
        self._speed_mps = math.nan
        self._other_mps = math.nan
        self._stood_ticks = 0

    def take(self, speed_mps: float) -> None:
        """Take the newest speed."""
        self.change_mps = change_mps = abs(speed_mps - self._speed_mps)
        # What is this small is no jump: almost every tick ends the question here.
        self.jumped = change_mps > self._step_mps and self._jumps(change_mps, speed_mps)
        self._stood_ticks = self._stood_ticks + 1 if change_mps == 0.0 else 0
        self._speed_mps = speed_mps

    def stuck_beside(self, other_mps: float) -> bool:
        """Whether it stands still on a way on which the other speed has moved; once a tick."""
        if not self._stood_ticks:
            self._other_mps = other_mps
            return False
        return self.stood_m > RING_M and far(other_mps, self._other_mps)

    @property
    def stood_m(self) -> float:
        """Way of the rim since the speed last changed."""
        return self._stood_ticks * self._period_s * self._speed_mps

    def _jumps(self, change_mps: float, speed_mps: float) -> bool:
        edges_mps = EDGE_MPS + EDGE_RATIO * min(speed_mps, self._speed_mps)
        return change_mps > self._step_mps * (self._stood_ticks + 2) + edges_mps


def near(speed_mps: float, other_mps: float, more_mps: float = 0.0) -> bool:
    """Whether two speeds agree; not where one is unknown."""
    return abs(speed_mps - other_mps) <= NEAR_MPS + NEAR_RATIO * other_mps + more_mps


def far(speed_mps: float, other_mps: float) -> bool:
    """Whether two speeds contradict each other; not where one is unknown."""
    return abs(speed_mps - other_mps) > NEAR_MPS + NEAR_RATIO * other_mps
