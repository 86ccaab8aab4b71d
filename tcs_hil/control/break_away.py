"""A ceiling on the torque after a wheel has broken away at low speed."""

from __future__ import annotations

import math
from typing import Final

from tcs_hil.control.carried_force import CarriedForce
from tcs_hil.control.protocol import WheelState
from tcs_hil.model.vehicle import Vehicle

FASTEST_MPS: Final = 4.0
"""Above it slip answers torque slowly enough for the law alone."""

SLIP_SHARE: Final = 2.0
LEAST_SLIP_MPS: Final = 0.2
"""A wheel has broken away beyond both: so many slip references, and so much slip speed."""

FORCE_SHARE: Final = 0.95
SENT_SHARE: Final = 0.7
"""What is left of the tyre's force, and at least of the torque at which the wheel broke away:
the force is seen late, and a tyre near standstill swings on its carcass."""

HOLD_S: Final = 0.3
GROWTH_S: Final = 0.4


class BreakAway:
    """Bounds a wheel's torque by what its tyre was seen to carry while it slid.

    Beyond its peak a tyre pushes less the more it slips.  At low speed the wheel
    then runs away faster than any command comes back from the bus, and a law that
    fetches each lost grip back at once swings between sticking and sliding.  So
    the torque stays a little below the force for a while, and then grows until
    the driver's request is free again or the wheel breaks away once more: a slow
    search in place of a limit cycle.  A wheel that slides before its tyre has
    built up its force, as under a stab at the pedal, shows later what it carries:
    the ceiling rises with that at once.
    """

    def __init__(self, slip_reference: float, vehicle: Vehicle, period_s: float) -> None:
        self._slip_ratio = SLIP_SHARE * slip_reference
        self._carried = CarriedForce(slip_reference, vehicle, period_s)
        self._period_s = period_s
        self._growth = math.exp(period_s / GROWTH_S)
        self._calm_s = math.inf  # since the wheel last slid
        self.reset()

    def ceiling_nm(self, wheel: WheelState, torque_ref_nm: float, sent_nm: float) -> float:
        """Most torque in [0, torque_ref_nm] that may follow ``sent_nm``; called once a tick."""
        self._carried.observe(wheel)
        carried_nm = FORCE_SHARE * self._carried.torque_nm
        if self._has_broken_away(wheel):
            if self._calm_s > HOLD_S:
                self._least_nm = SENT_SHARE * sent_nm
            self._ceiling_nm = max(carried_nm, self._least_nm)
            self._calm_s = 0.0
        else:
            self._calm_s += self._period_s
            grown_nm = self._ceiling_nm * (self._growth if self._calm_s > HOLD_S else 1.0)
            self._ceiling_nm = max(carried_nm, grown_nm)
        if self._ceiling_nm >= torque_ref_nm:
            self._ceiling_nm = math.inf
        return min(self._ceiling_nm, torque_ref_nm)

    def reset(self) -> None:
        """Nothing is known of the road."""
        self._carried.reset()
        self._ceiling_nm = math.inf
        self._least_nm = 0.0
        self._calm_s = math.inf

    def _has_broken_away(self, wheel: WheelState) -> bool:
        return (
            wheel.vehicle_speed_mps < FASTEST_MPS
            and wheel.slip_ratio > self._slip_ratio
            and wheel.slip_speed_mps > LEAST_SLIP_MPS
        )
