"""Speed of the body: rear wheels for the truth, accelerometer for the time between their edges."""

from __future__ import annotations

import math

from tcs_hil.signals import Pair

STILL_S = 0.25
"""A speed that has not changed for so long is one of its own, not an average of the past."""

SPEED_GAIN_PER_S = 10.0
BIAS_GAIN_PER_S2 = 10.0
"""Both poles near 5 per second: slower than the gaps between edges, faster than grade and pitch."""

MOST_PER_EDGE = 0.5


class BodySpeed:
    """Luenberger observer of [v, b]: v' = a - b, with b what the accelerometer feels too much.

    b takes up its bias, the grade and the pitch.  A toothed sensor's speed is the
    mean over the time between two edges: it is compared with the speed half that
    time ago, once, when it appears on the bus.  The bus does not say how many
    teeth there are; how long a value has stood does.
    """

    def __init__(self, period_s: float) -> None:
        self._period_s = period_s
        self._known = False  # the first speed is taken as it is
        self._bias_mps2 = 0.0
        self._seen_mps: Pair = (math.nan, math.nan)
        self._stood_s = [0.0, 0.0]
        self.value_mps = 0.0

    def update(self, rear_mps: Pair, trusted: tuple[bool, bool], accel_mps2: float) -> float:
        """Speed now, m/s, from the rear wheels' rim speeds and the acceleration felt."""
        if not self._known:
            self._take_over(rear_mps, trusted)
            return self.value_mps
        rate_mps2 = accel_mps2 - self._bias_mps2
        self.value_mps = max(self.value_mps + self._period_s * rate_mps2, 0.0)
        for side in range(2):
            self._stood_s[side] += self._period_s
            still = self._stood_s[side] > STILL_S
            if trusted[side] and (still or rear_mps[side] != self._seen_mps[side]):
                age_s = 0.0 if still else 0.5 * self._stood_s[side]
                self._correct(side, rear_mps[side] - (self.value_mps - age_s * rate_mps2))
        self._seen_mps = rear_mps
        return self.value_mps

    def _take_over(self, rear_mps: Pair, trusted: tuple[bool, bool]) -> None:
        speeds = [speed for speed, good in zip(rear_mps, trusted, strict=True) if good]
        if speeds:
            self._known = True
            self.value_mps = sum(speeds) / len(speeds)
            self._seen_mps = rear_mps

    def _correct(self, side: int, surprise_mps: float) -> None:
        """Weigh one wheel's news by the time it stands for; two wheels share the gain."""
        weight_s = 0.5 * min(self._stood_s[side], STILL_S)
        self._stood_s[side] = 0.0
        self.value_mps += min(SPEED_GAIN_PER_S * weight_s, MOST_PER_EDGE) * surprise_mps
        self._bias_mps2 -= BIAS_GAIN_PER_S2 * weight_s * surprise_mps
