"""The integral of the slip error, Eq. (e_int), with the anti-windup of each preset."""

from __future__ import annotations

from typing import Final

REDUCTION_THRESHOLD_NM: Final = 1.0


class SlipErrorIntegral:
    """e_int of one wheel, in seconds of unit slip; both predictive laws share it.

    It advances only while the law reduces the driver's torque, by more than
    1 Nm; otherwise the error says nothing about the law and e_int would wind up
    for as long as the driver's ramp takes.

    The torque is compared with the request it was computed for.  Comparing it
    with the next request looks the same and is a trap: the paper's ramp rises
    by exactly 1 Nm per tick, so rounding alone would decide, and does: e_int
    then winds up before the slip is anywhere near its reference.
    """

    def __init__(self, slip_reference: float, period_s: float) -> None:
        self._slip_reference = slip_reference
        self._period_s = period_s
        self.value_s = 0.0

    def advance(self, slip_ratio: float, torque_nm: float, torque_ref_nm: float) -> None:
        """Euler step over the period in which ``torque_nm`` answers ``torque_ref_nm``."""
        if torque_ref_nm > 0.0 and abs(torque_ref_nm - torque_nm) > REDUCTION_THRESHOLD_NM:
            self.value_s += self._period_s * (self._slip_reference - slip_ratio)

    def reset(self) -> None:
        """Back to zero."""
        self.value_s = 0.0


class BoundedIntegral:
    """e_int of the default laws: bounded, and frozen where it could only wind up.

    At a bound of the torque an error that pushes further outwards says nothing
    about the law; one that leads back inside counts.
    """

    def __init__(self, slip_reference: float, period_s: float, limit_s: float) -> None:
        self._slip_reference = slip_reference
        self._period_s = period_s
        self._limit_s = limit_s
        self.value_s = 0.0

    def advance(self, slip_ratio: float, torque_nm: float, torque_ref_nm: float) -> None:
        """Euler step over the period in which ``torque_nm`` answers ``torque_ref_nm``."""
        error = self._slip_reference - slip_ratio
        at_top = torque_nm >= torque_ref_nm - REDUCTION_THRESHOLD_NM
        at_bottom = torque_nm <= REDUCTION_THRESHOLD_NM
        if (error > 0.0 and at_top) or (error < 0.0 and at_bottom):
            return
        value_s = self.value_s + self._period_s * error
        self.value_s = min(max(value_s, -self._limit_s), self._limit_s)

    def reset(self) -> None:
        """Back to zero."""
        self.value_s = 0.0
