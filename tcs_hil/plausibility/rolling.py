"""The axle nobody drives: two wheels and the accelerometer, three witnesses of one speed."""

from __future__ import annotations

import math

from tcs_hil.plausibility.trace import NEAR_MPS, NEAR_RATIO, Duration, SpeedTrace, near
from tcs_hil.signals import Pair

RATE_MPS2 = 16.0  # beyond it nothing that only rolls gains or loses speed
CURVE_RATIO, CURVE_M2PS2 = 0.35, 16.0  # left from right: tightest curve; lateral m/s2 times track
FASTER_RATIO, FASTER_MPS = 0.1, 0.5  # than the fastest driven wheel
ASTRAY_MPS = 0.7  # of an acceleration that two wheels contradict
ACCEL_MAX_MPS2 = 20.0

APART_S, FASTER_S, HEALED_S = 0.05, 0.1, 0.1
BLIND_S = 1.0  # the accelerometer alone carries a speed no longer
BLIND_MPS2 = 0.5  # and this is how fast it grows uncertain
PARDON_S = 1.0  # an accelerometer is then tried again

MOVING_MPS = 3.0
IDLE_NM = 10.0
SPEED_GAIN_PER_S, BIAS_GAIN_PER_S2 = 10.0, 10.0


class RollingWheel:
    """One wheel and whether it is believed."""

    def __init__(self, period_s: float) -> None:
        self.suspected = False
        self.speed_mps = math.nan
        self._trace = SpeedTrace(RATE_MPS2, period_s)
        self._faster = Duration(FASTER_S, period_s)
        self._healed = Duration(HEALED_S, period_s)

    def take(self, speed_mps: float, other_mps: float) -> bool:
        """Judge the newest speed by its own course and the other's; whether it is believed."""
        self.speed_mps = speed_mps
        self._trace.take(speed_mps, other_mps)
        if self._trace.jumped or self._trace.stuck:
            self.suspected = True
        return not self.suspected and not math.isnan(speed_mps)

    def compare(self, most_mps: float) -> None:
        """Judge it by the driven wheels, which are the faster ones while they drive."""
        if self._faster.reached(self.speed_mps > most_mps):
            self.suspected = True

    def heals(self, agrees: bool) -> bool:
        """Believe it again when it has agreed for long enough; whether that is now."""
        healed = self._healed.reached(agrees)
        self.suspected = not healed
        return healed


class RollingAxle:
    """Left and right wheel, and a speed of the car carried on by its acceleration."""

    def __init__(self, period_s: float) -> None:
        self.left, self.right = RollingWheel(period_s), RollingWheel(period_s)
        self.accel_suspected = False
        self.speed_mps = math.nan  # of the car, as far as it is known
        self._period_s = period_s
        self._apart = Duration(APART_S, period_s)
        self._astray = Duration(APART_S, period_s)
        self._pardon_s = 0.0
        self._blind_s = 0.0
        self._bias_mps2 = 0.0

    def take(self, left_mps: float, right_mps: float, accel_mps2: float) -> None:
        """Hear the two wheels and the accelerometer, NaN for none."""
        left = self.left.take(left_mps, right_mps)
        right = self.right.take(right_mps, left_mps)
        self._carry_on(accel_mps2)
        if left and right:
            self._contradict(left_mps, right_mps)
            self._learn(0.5 * (left_mps + right_mps))
        elif left or right:
            self._learn(left_mps if left else right_mps)
        else:
            self._blind_s += self._period_s

    def compare(self, driven_mps: float, motors_nm: Pair) -> None:
        """Hear the faster one of the driven wheels, and what the motors give."""
        least_nm, most_nm = min(motors_nm), max(motors_nm)
        driving = least_nm > IDLE_NM
        most_mps = (1.0 + FASTER_RATIO) * driven_mps + FASTER_MPS if driving else math.inf
        self.left.compare(max(most_mps, MOVING_MPS))
        self.right.compare(max(most_mps, MOVING_MPS))
        if self.left.suspected or self.right.suspected:
            idle = least_nm > -IDLE_NM and most_nm < IDLE_NM
            self._heal(self.left, driven_mps if idle else math.nan)
            self._heal(self.right, driven_mps if idle else math.nan)

    def _heal(self, wheel: RollingWheel, rolling_mps: float) -> None:
        """Believe what agrees with the car's speed, or with driven wheels that only roll."""
        if not wheel.suspected:
            return
        known = self._blind_s < BLIND_S
        agrees = known and near(wheel.speed_mps, self.speed_mps, BLIND_MPS2 * self._blind_s)
        if wheel.heals(agrees or near(wheel.speed_mps, rolling_mps)):
            self.speed_mps = wheel.speed_mps

    def _carry_on(self, accel_mps2: float) -> None:
        self._pardon_s = max(self._pardon_s - self._period_s, 0.0)
        if abs(accel_mps2) > ACCEL_MAX_MPS2:
            self._pardon_s = PARDON_S
        self.accel_suspected = self._pardon_s > 0.0
        if not self.accel_suspected and not math.isnan(accel_mps2):
            gained_mps = self._period_s * (accel_mps2 - self._bias_mps2)
            self.speed_mps = max(self.speed_mps + gained_mps, 0.0)

    def _contradict(self, left_mps: float, right_mps: float) -> None:
        """Two wheels against each other, or both against the accelerometer."""
        mean_mps = 0.5 * (left_mps + right_mps)
        curve_mps = min(CURVE_RATIO * mean_mps, CURVE_M2PS2 / max(mean_mps, 1.0))
        if self._apart.reached(abs(left_mps - right_mps) > NEAR_MPS + curve_mps):
            self.left.suspected = self.right.suspected = True
        astray = abs(mean_mps - self.speed_mps) > ASTRAY_MPS + NEAR_RATIO * mean_mps
        if self._astray.reached(astray and mean_mps > MOVING_MPS):
            self._pardon_s = PARDON_S
            self.speed_mps = mean_mps

    def _learn(self, speed_mps: float) -> None:
        error_mps = speed_mps - self.speed_mps
        self._blind_s = 0.0
        if not math.isfinite(error_mps):  # the first speed is taken as it is
            self.speed_mps = speed_mps
            return
        self.speed_mps += SPEED_GAIN_PER_S * self._period_s * error_mps
        self._bias_mps2 -= BIAS_GAIN_PER_S2 * self._period_s * error_mps
