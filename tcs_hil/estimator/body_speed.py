"""Speed of the body: rear wheels for the truth, accelerometer for the time between their edges."""

from __future__ import annotations

import math
from typing import Final

from tcs_hil.signals import Pair

STILL_S: Final = 0.25
"""A speed that has not changed for so long is one of its own, not an average of the past."""

STANDS_MPS: Final = 0.03
"""Front wheels that turn no faster stand; their motors show it to a fraction of this."""

STANDING_S: Final = 0.1
"""Time constant in which a standing car learns what its accelerometer feels too much."""

FIRST_EDGES_S: Final = 1.0
"""A car that moves off has met two edges of any rear wheel by then."""

SPEED_GAIN_PER_S: Final = 10.0
BIAS_GAIN_PER_S2: Final = 10.0
"""Poles at 1.1 and 8.9 per second: slower than the gaps between edges, faster than most grades."""

FIRST_SPEED_SHARE: Final = 2.0
FIRST_BIAS_SHARE: Final = 10.0
FIRST_S: Final = 0.3
"""So much larger both gains begin on a car that rolls, with two poles at 10 per second: nothing is
known of its grade.  The surplus dies away with this time constant."""

MOST_PER_EDGE: Final = 0.5


class BodySpeed:
    """Luenberger observer of [v, b]: v' = a - b, with b what the accelerometer feels too much.

    b takes up its bias, the grade and the pitch.  A toothed sensor's speed is the
    mean over the time between two edges: it is compared with the speed half that
    time ago, once, when it appears on the bus.  The bus does not say how many
    teeth there are; how long a value has stood does.  What is met rolling is
    learnt with larger gains at first, as a Kalman filter would.

    A rear wheel shows zero until it has met two edges.  While the front wheels,
    seen through their motors, stand too, so does the car, and all the
    accelerometer feels is b; once they turn, a zero says nothing for a while.
    """

    def __init__(self, period_s: float) -> None:
        self._period_s = period_s
        self._known = False  # the first speed is taken as it is
        self._bias_mps2 = 0.0
        self._newness = 1.0  # of the bias: 1 while nothing is known of it
        self._fading = 1.0 - math.exp(-period_s / FIRST_S)
        self._seen_mps: Pair = (math.nan, math.nan)
        self._stood_s = [0.0, 0.0]
        self.value_mps = 0.0
        self.accel_mps2 = 0.0

    def update(
        self, rear_mps: Pair, trusted: tuple[bool, bool], accel_mps2: float, driven_mps: float
    ) -> float:
        """Speed now, m/s, from the rear wheels' rim speeds and the acceleration felt.

        ``driven_mps`` is the rim speed of the faster front wheel.
        """
        if not self._known:
            self._take_over(rear_mps, trusted)
            return self.value_mps
        if driven_mps < STANDS_MPS and rear_mps == (0.0, 0.0):
            self._stand(rear_mps, accel_mps2)
            return self.value_mps
        rate_mps2 = self.accel_mps2 = accel_mps2 - self._bias_mps2
        self._newness -= self._fading * self._newness
        self.value_mps = max(self.value_mps + self._period_s * rate_mps2, 0.0)
        self._hear(0, rear_mps[0], self._seen_mps[0], trusted[0], rate_mps2)
        self._hear(1, rear_mps[1], self._seen_mps[1], trusted[1], rate_mps2)
        self._seen_mps = rear_mps
        return self.value_mps

    def _hear(
        self, side: int, rim_mps: float, seen_mps: float, trusted: bool, rate_mps2: float
    ) -> None:
        """One wheel's speed, and the one before."""
        stood_s = self._stood_s[side] = self._stood_s[side] + self._period_s
        starts = seen_mps == 0.0 and stood_s < FIRST_EDGES_S
        still = stood_s > STILL_S and not starts
        news = rim_mps != seen_mps
        if starts and news:
            self._stood_s[side] = 0.0  # a mean over nobody knows how long
        elif trusted and (still or news):
            age_s = 0.0 if still else 0.5 * stood_s
            self._correct(side, rim_mps - (self.value_mps - age_s * rate_mps2))

    def _stand(self, rear_mps: Pair, accel_mps2: float) -> None:
        """Nothing turns: what is felt is the accelerometer's error and the grade."""
        self.value_mps = self.accel_mps2 = self._newness = 0.0
        share = self._period_s / STANDING_S
        self._bias_mps2 += share * (accel_mps2 - self._bias_mps2)
        self._seen_mps = rear_mps
        self._stood_s = [0.0, 0.0]

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
        speed_gain = SPEED_GAIN_PER_S * _grown(FIRST_SPEED_SHARE, self._newness) * weight_s
        bias_gain = BIAS_GAIN_PER_S2 * _grown(FIRST_BIAS_SHARE, self._newness) * weight_s
        self.value_mps += min(speed_gain, MOST_PER_EDGE) * surprise_mps
        self._bias_mps2 -= bias_gain * surprise_mps


def _grown(share: float, newness: float) -> float:
    """Factor on a gain: from ``share`` down to 1."""
    return 1.0 + (share - 1.0) * newness
