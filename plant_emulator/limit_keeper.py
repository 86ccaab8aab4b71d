"""The motor side of the torque limit: obey it, hold it when it stops coming, then let go gently."""

from __future__ import annotations

import math

from plant_emulator.inverter import Demand
from plant_emulator.pedal import Line
from tcs_hil.signals import NO_LIMIT, Pair, TorqueLimits

HOLD_S = 0.010
RELEASE_NMPS = 500.0


class LimitKeeper:
    """Remembers the limits last received.

    They hold for 10 ms.  Without new ones they then rise by 500 Nm/s until the
    driver's request is the lower one: a lost controller never means lost drive,
    and never a step.
    """

    def __init__(self) -> None:
        self._limits = TorqueLimits()
        self._expiry_s = math.inf

    def accept(self, limits: TorqueLimits, time_s: float) -> None:
        """Take over limits that arrived at ``time_s``."""
        self._limits = limits
        self._expiry_s = math.inf if limits == (NO_LIMIT, NO_LIMIT) else time_s + HOLD_S

    def next_change(self, time_s: float) -> float:
        """When the hold ends, if that is still to come."""
        return self._expiry_s if self._expiry_s > time_s else math.inf

    def demand(self, request: Line, time_s: float) -> Demand:
        """Request and limits from ``time_s`` until `next_change`."""
        slope = RELEASE_NMPS if time_s >= self._expiry_s else 0.0
        return Demand(
            (request.value, request.value),
            (request.slope, request.slope),
            self.limits_nm(time_s),
            (slope, slope),
        )

    def limits_nm(self, time_s: float) -> Pair:
        """Limits in force at ``time_s``."""
        released_nm = RELEASE_NMPS * max(time_s - self._expiry_s, 0.0)
        return (self._limits.left_nm + released_nm, self._limits.right_nm + released_nm)
