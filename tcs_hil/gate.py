"""Last word on one motor's torque: finite, within [0, request], and raised no faster than allowed.

Independent of controller, supervisor and plausibility: it knows a wish, what
the driver asks, and how far it may be trusted to raise.
"""

from __future__ import annotations

import math
from collections import deque
from enum import IntEnum
from typing import Final

from tcs_hil.safety_settings import GateSettings
from tcs_hil.signals import NO_LIMIT

BEYOND_ANY_REQUEST_NM: Final = 1_000.0
"""Stands for a request that nobody knows: no motor of a car asks for more."""


class Permission(IntEnum):
    """What the supervisor lets a gate do with the controllers' proposals; stricter is greater."""

    FOLLOW = 0
    FOLLOW_SLOWLY = 1  # lowered at once, raised no faster than released
    HOLD = 2  # lowered, never raised
    RELEASE = 3  # the controllers are not asked; the driver gets the torque back


FOLLOW: Final = Permission.FOLLOW
FOLLOW_SLOWLY: Final = Permission.FOLLOW_SLOWLY
HOLD: Final = Permission.HOLD
RELEASE: Final = Permission.RELEASE


class Gate:
    """One motor's gate.  Total: any float in, a number in [0, request] or ``NO_LIMIT`` out.

    From one finite ceiling to the next it rises by no more than the permission
    allows, whatever the request does in between.  A law that is trusted again is
    followed slowly until the ceiling has met what it wants.  Losing the controller
    must never mean losing the car: RELEASE ramps the ceiling up to the driver's
    request and then lifts it.
    """

    def __init__(self, settings: GateSettings, period_s: float) -> None:
        released_nm = settings.release_rate_nmps * period_s
        trusted_nm = settings.rise_rate_nmps * period_s
        self._rise_nm = (trusted_nm, released_nm, 0.0, released_nm)  # by Permission
        self._fall_nm = settings.fall_rate_nmps * period_s
        self._slack_nm = settings.slack_nm
        self._window_rise_nm = settings.window_rise_nm
        self._window_nm: deque[float] = deque(maxlen=max(round(settings.window_s / period_s), 1))
        self._lift_ticks = round(settings.lift_s / period_s)
        self._ticks_to_lift = 0
        self._ceiling_nm = NO_LIMIT
        self._behind = False  # not met what is wanted since it was last not trusted

    def limit(self, wanted_nm: float, request_nm: float, permission: Permission) -> float:
        """Ceiling (Nm, or ``NO_LIMIT``) for the coming period."""
        known = -math.inf < request_nm < math.inf
        most_nm = max(request_nm, 0.0) if known else BEYOND_ANY_REQUEST_NM
        before_nm = min(self._ceiling_nm, most_nm)  # without a ceiling the request is in force
        target_nm = _target_nm(wanted_nm, before_nm, most_nm, permission)
        highest_nm = min(before_nm + self._rise(wanted_nm, before_nm, permission), most_nm)
        # No ceiling is below zero, so the window never forbids less than its rise.
        if target_nm > max(before_nm, self._window_rise_nm) and self._window_nm:
            highest_nm = min(highest_nm, min(self._window_nm) + self._window_rise_nm)
        ceiling_nm = min(max(target_nm, before_nm - self._fall_nm, 0.0), highest_nm)
        self._ceiling_nm = self._kept_or_lifted(ceiling_nm, most_nm, permission)
        return self._ceiling_nm

    def _rise(self, wanted_nm: float, before_nm: float, permission: Permission) -> float:
        """Most it may rise now; trust comes back without a step, once wish and ceiling have met."""
        if permission is not FOLLOW:
            self._behind = True
        elif wanted_nm <= before_nm:
            self._behind = False
        elif self._behind:
            permission = FOLLOW_SLOWLY
        return self._rise_nm[permission]

    def _kept_or_lifted(self, ceiling_nm: float, most_nm: float, permission: Permission) -> float:
        """The ceiling, or ``NO_LIMIT`` where it holds nothing back."""
        unlimited = self._ceiling_nm == NO_LIMIT
        fell = not unlimited and most_nm < self._ceiling_nm
        self._ticks_to_lift = self._lift_ticks if fell else max(self._ticks_to_lift - 1, 0)
        may_lift = permission is not HOLD and not self._ticks_to_lift
        if ceiling_nm >= most_nm - self._slack_nm and (unlimited or may_lift):
            self._window_nm.clear()
            return NO_LIMIT
        self._window_nm.append(ceiling_nm)
        return ceiling_nm


def _target_nm(wanted_nm: float, before_nm: float, most_nm: float, permission: Permission) -> float:
    if permission is RELEASE:
        return most_nm
    return wanted_nm if -math.inf < wanted_nm < math.inf else before_nm
