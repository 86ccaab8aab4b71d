"""The axle nobody drives: two wheels and the accelerometer, three witnesses of one speed."""

from __future__ import annotations

import math
from typing import Final

from tcs_hil.plausibility.trace import NEAR_MPS, NEAR_RATIO, Duration, SpeedTrace, near
from tcs_hil.signals import Pair

RATE_MPS2: Final = 16.0  # beyond it nothing that only rolls gains or loses speed
CURVE_RATIO: Final = 0.35  # left from right, in the tightest curve
CURVE_M2PS2: Final = 16.0  # the same: lateral acceleration times track
FASTER_RATIO: Final = 0.1  # than the fastest driven wheel
FASTER_MPS: Final = 0.5
ASTRAY_MPS: Final = 0.7  # of an acceleration that two wheels contradict
SPEED_MAX_MPS: Final = 110.0  # of any car
ACCEL_MAX_MPS2: Final = 20.0

APART_S: Final = 0.05
FASTER_S: Final = 0.1
HEALED_S: Final = 0.1
BLIND_S: Final = 1.0  # the accelerometer alone carries a speed no longer
BLIND_MPS2: Final = 0.5  # and this is how fast it grows uncertain
PARDON_S: Final = 1.0  # an accelerometer is then tried again

MOVING_MPS: Final = 3.0
IDLE_NM: Final = 10.0
SPEED_GAIN_PER_S: Final = 10.0
BIAS_GAIN_PER_S2: Final = 10.0


class RollingWheel:
    """One wheel and whether it is believed."""

    def __init__(self, period_s: float) -> None:
        self.suspected = False
        self.too_fast = False
        self.speed_mps = math.nan
        self._trace = SpeedTrace(RATE_MPS2, period_s)
        self._faster = Duration(FASTER_S, period_s)
        self._healed = Duration(HEALED_S, period_s)

    @property
    def believed_mps(self) -> float:
        """The speed, NaN while it is not believed."""
        return math.nan if self.suspected else self.speed_mps

    def take(self, speed_mps: float) -> None:
        """Judge the newest speed by its own course."""
        self.speed_mps = speed_mps
        self._trace.take(speed_mps)
        if self._trace.jumped or speed_mps > SPEED_MAX_MPS:
            self.suspected = True

    def stand_beside(self, other_mps: float) -> None:
        """Judge it by the other wheel of the axle, NaN unless that is believed."""
        if self._trace.stuck_beside(other_mps):
            self.suspected = True

    def compare(self, most_mps: float) -> None:
        """Judge it by the driven wheels, which are the faster ones while they drive."""
        self.too_fast = self.speed_mps > most_mps
        if self._faster.reached(self.too_fast):
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
        self._contradiction = False  # of the two wheels, beyond what a curve explains
        self._apart = Duration(APART_S, period_s)
        self._astray = Duration(APART_S, period_s)
        self._pardon_s = 0.0
        self._blind_s = 0.0
        self._bias_mps2 = 0.0
        self._speed_gain = SPEED_GAIN_PER_S * period_s
        self._bias_gain = BIAS_GAIN_PER_S2 * period_s

    def take(self, left_mps: float, right_mps: float, accel_mps2: float) -> None:
        """Hear the two wheels and the accelerometer, NaN for none."""
        left, right = self.left, self.right
        left.take(left_mps)
        right.take(right_mps)
        left.stand_beside(right.believed_mps)
        right.stand_beside(left.believed_mps)
        self._carry_on(accel_mps2)
        mean_mps = 0.5 * (left_mps + right_mps)
        self._compare_with_each_other(left_mps - right_mps, mean_mps)
        self._learn(left.believed_mps, right.believed_mps)

    def compare(self, driven_mps: float, motors_nm: Pair) -> None:
        """Hear the faster one of the driven wheels, and what the motors give."""
        left_nm, right_nm = motors_nm
        least_nm, most_nm = min(left_nm, right_nm), max(left_nm, right_nm)
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
        witness = self._blind_s < BLIND_S and not self._contradiction and not wheel.too_fast
        more_mps = BLIND_MPS2 * self._blind_s
        agrees = witness and near(wheel.speed_mps, self.speed_mps, more_mps)
        if wheel.heals(agrees or near(wheel.speed_mps, rolling_mps)):
            self.speed_mps = wheel.speed_mps

    def _carry_on(self, accel_mps2: float) -> None:
        if abs(accel_mps2) > ACCEL_MAX_MPS2:
            self._pardon_s = PARDON_S
        self.accel_suspected = self._pardon_s > 0.0
        if self.accel_suspected:
            self._pardon_s -= self._period_s
        elif not math.isnan(accel_mps2):
            gained_mps = self._period_s * (accel_mps2 - self._bias_mps2)
            self.speed_mps = max(self.speed_mps + gained_mps, 0.0)

    def _compare_with_each_other(self, gap_mps: float, mean_mps: float) -> None:
        """Two wheels against each other, or both against the accelerometer."""
        left, right = self.left, self.right
        curve_mps = min(CURVE_RATIO * mean_mps, CURVE_M2PS2 / max(mean_mps, 1.0))
        self._contradiction = abs(gap_mps) > NEAR_MPS + curve_mps
        if left.suspected or right.suspected:
            return
        if self._apart.reached(self._contradiction):
            left.suspected = right.suspected = True
        astray = abs(mean_mps - self.speed_mps) > ASTRAY_MPS + NEAR_RATIO * mean_mps
        if self._astray.reached(astray and mean_mps > MOVING_MPS):
            self._pardon_s = PARDON_S
            self.speed_mps = mean_mps

    def _learn(self, left_mps: float, right_mps: float) -> None:
        """Correct the speed by the wheels that are believed, as far as there are any."""
        speed_mps = 0.5 * (left_mps + right_mps)
        if math.isnan(speed_mps):
            speed_mps = right_mps if math.isnan(left_mps) else left_mps
        if math.isnan(speed_mps):
            self._blind_s += self._period_s
            return
        self._blind_s = 0.0
        error_mps = speed_mps - self.speed_mps
        if -math.inf < error_mps < math.inf:
            self.speed_mps += self._speed_gain * error_mps
            self._bias_mps2 -= self._bias_gain * error_mps
        else:  # the first speed is taken as it is
            self.speed_mps = speed_mps
