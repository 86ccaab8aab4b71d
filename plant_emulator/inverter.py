"""The motor side of the torque limit: obey it, hold it when it stops coming, then let go gently."""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

from plant_emulator.compiled import compiled
from plant_emulator.driver import Line
from tcs_hil.signals import NO_LIMIT, Pair, TorqueLimits

HOLD_S = 0.010
RELEASE_NMPS = 500.0


class Demand(NamedTuple):
    """What each motor is asked for over one piece of time, as straight lines from its start."""

    request_nm: Pair
    request_nmps: Pair
    limit_nm: Pair
    limit_nmps: Pair


Lines: TypeAlias = tuple[Pair, ...]
"""A demand without its names, which Python hands to compiled code in a third of the time."""


@compiled
def demanded(demand: Demand, elapsed_s: float) -> Pair:
    """Torque asked of the left and the right motor: the lower of request and limit."""
    return (
        min(
            demand.request_nm[0] + demand.request_nmps[0] * elapsed_s,
            demand.limit_nm[0] + demand.limit_nmps[0] * elapsed_s,
        ),
        min(
            demand.request_nm[1] + demand.request_nmps[1] * elapsed_s,
            demand.limit_nm[1] + demand.limit_nmps[1] * elapsed_s,
        ),
    )


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
