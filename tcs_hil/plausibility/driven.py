"""A driven wheel and its motor: two sensors of one rotation, and the torque between them."""

from __future__ import annotations

import math
from typing import Final

from tcs_hil.plausibility.trace import Duration, SpeedTrace

APART_RATIO: Final = 0.1  # the shaft twists, and a ring tells late
APART_MPS: Final = 0.8
SLOWER_RATIO: Final = 0.03  # than the rolling wheels no driven one is
SLOWER_MPS: Final = 0.2
STEP_MPS: Final = 0.5  # by which the two do not part in one tick
STOOD_M: Final = 0.1  # way on which a sensor that works has moved
FLUTTER_NM: Final = 40.0  # which no motor changes by tick after tick
MUTE_RATIO: Final = 0.1  # gives so little of so much it may give
MUTE_NM: Final = 50.0

APART_S: Final = 0.05
HEALED_S: Final = 0.1
RECENT_S: Final = 0.2
FLUTTER_S: Final = 0.02
MUTE_S: Final = 0.1


class DrivenWheel:
    """Whether wheel and motor turn together, and if not, which of the two is wrong."""

    def __init__(self, period_s: float) -> None:
        self.wheel_suspected = False
        self.motor_suspected = False
        self._wheel = SpeedTrace(math.inf, period_s)
        self._motor = SpeedTrace(math.inf, period_s)
        self._gap_mps = math.nan
        self._wheel_stepped = self._motor_stepped = False
        self._recent_ticks = round(RECENT_S / period_s)
        self._remembered_ticks = 0
        self._apart = Duration(APART_S, period_s)
        self._together = Duration(HEALED_S, period_s)

    def take(self, wheel_mps: float, motor_mps: float, rolling_mps: float) -> float:
        """Hear both speeds, and that of the rolling wheels to decide between them.

        Returns the rim's speed: by the motor, which is the better sensor, or by the wheel.
        """
        self._wheel.take(wheel_mps)
        self._motor.take(motor_mps)
        stuck = self._wheel.stuck_beside(motor_mps) | self._motor.stuck_beside(wheel_mps)
        gap_mps = wheel_mps - motor_mps
        apart = abs(gap_mps) > APART_MPS + APART_RATIO * wheel_mps
        self._notice_step(gap_mps)
        if self.wheel_suspected or self.motor_suspected:
            self._heal(not stuck and not apart and not math.isnan(gap_mps))
        elif self._apart.reached(apart) or stuck:
            least_mps = (1.0 - SLOWER_RATIO) * rolling_mps - SLOWER_MPS
            self._accuse((wheel_mps < least_mps, motor_mps < least_mps))
        return wheel_mps if self.motor_suspected or math.isnan(motor_mps) else motor_mps

    def _notice_step(self, gap_mps: float) -> None:
        """Remember for a while who moved when the two first parted in one tick."""
        if abs(gap_mps - self._gap_mps) > STEP_MPS and not self._remembered_ticks:
            self._wheel_stepped = self._wheel.change_mps > self._motor.change_mps
            self._motor_stepped = not self._wheel_stepped
            self._remembered_ticks = self._recent_ticks
        elif self._remembered_ticks:
            self._remembered_ticks -= 1
        else:
            self._wheel_stepped = self._motor_stepped = False
        self._gap_mps = gap_mps

    def _accuse(self, slower: tuple[bool, bool]) -> None:
        """Who is slower than a driven wheel can be, who stepped, who stands still; else both."""
        stepped = (self._wheel_stepped, self._motor_stepped)
        standing = (self._wheel.stood_m > STOOD_M, self._motor.stood_m > STOOD_M)
        decisive = (pair for pair in (slower, stepped, standing) if pair[0] != pair[1])
        self.wheel_suspected, self.motor_suspected = next(decisive, (True, True))

    def _heal(self, agree: bool) -> None:
        if self._together.reached(agree):
            self.wheel_suspected = self.motor_suspected = False


class MotorTorque:
    """Whether the torque a motor reports can be one."""

    def __init__(self, period_s: float) -> None:
        self.suspected = False
        self._torque_nm = math.nan
        self._flutter = Duration(FLUTTER_S, period_s)
        self._mute = Duration(MUTE_S, period_s)
        self._calm = Duration(HEALED_S, period_s)

    def take(self, torque_nm: float, allowed_nm: float) -> None:
        """Hear what the motor is said to give, and what it was allowed to."""
        flutters = self._flutter.reached(abs(torque_nm - self._torque_nm) > FLUTTER_NM)
        mute = self._mute.reached(allowed_nm > MUTE_NM and torque_nm < MUTE_RATIO * allowed_nm)
        self._torque_nm = torque_nm
        wrong = flutters or mute
        healed = self._calm.reached(self.suspected and not wrong)
        self.suspected = wrong or (self.suspected and not healed)
