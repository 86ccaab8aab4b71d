"""Last word on one motor's torque: finite, within [0, request], and never a raise in trouble."""

from __future__ import annotations

import math
from enum import Enum
from typing import Annotated

import msgspec

from tcs_hil.signals import NO_LIMIT


class Permission(Enum):
    """What the supervisor lets a gate do with the controllers' proposals."""

    FOLLOW = "follow"
    HOLD = "hold"
    RELEASE = "release"


class GateSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """``release_rate_nmps``: how fast a limit that is given up returns to the request."""

    release_rate_nmps: Annotated[float, msgspec.Meta(gt=0.0)] = 500.0
    slack_nm: Annotated[float, msgspec.Meta(ge=0.0)] = 0.05


class Gate:
    """One motor's gate.  Total: any float in, a number in [0, request] or ``NO_LIMIT`` out.

    Losing the controller must never mean losing the car: RELEASE ramps the
    ceiling up to the driver's request and then lifts it.
    """

    def __init__(self, settings: GateSettings, period_s: float) -> None:
        self._slack_nm = settings.slack_nm
        self._release_step_nm = settings.release_rate_nmps * period_s
        self._limit_nm = NO_LIMIT

    def limit(self, wanted_nm: float, request_nm: float, permission: Permission) -> float:
        """Ceiling (Nm, or ``NO_LIMIT``) for the coming period."""
        self._limit_nm = self._ceiling(wanted_nm, request_nm, permission)
        may_lift = permission is not Permission.HOLD
        if may_lift and self._limit_nm >= request_nm - self._slack_nm:
            self._limit_nm = NO_LIMIT
        # An unknown request compares as false everywhere: the ceiling then stands alone.
        binding = self._limit_nm < NO_LIMIT and request_nm < self._limit_nm
        return max(request_nm, 0.0) if binding else self._limit_nm

    def _ceiling(self, wanted_nm: float, request_nm: float, permission: Permission) -> float:
        if permission is Permission.RELEASE:
            return self._limit_nm + self._release_step_nm
        if not (math.isfinite(wanted_nm) and math.isfinite(request_nm)):
            return self._limit_nm
        ceiling_nm = max(wanted_nm, 0.0)
        return min(ceiling_nm, self._limit_nm) if permission is Permission.HOLD else ceiling_nm
