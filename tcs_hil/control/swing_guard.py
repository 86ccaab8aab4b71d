"""What ends a limit cycle while it begins: torque held where the swing was, then given back."""

from __future__ import annotations

import math
from typing import Final

from tcs_hil.control.carried_force import CarriedForce
from tcs_hil.control.friction_rise import FrictionRise
from tcs_hil.control.protocol import WheelState
from tcs_hil.control.swings import SwingMean, Swings
from tcs_hil.model.vehicle import Vehicle

LEAST_SLIP_RATIO: Final = 0.05
LEAST_SLIP_MPS: Final = 0.06
LEAST_NM: Final = 20.0
FED_NM: Final = 10.0
"""A swing of slip is beyond both of the first, one of torque beyond the third; a torque that moves
by the last feeds the slip's swings, or at least answers them."""
TURNS: Final = 3
"""So many turns in a row are a limit cycle that begins."""

STAB_NMPS: Final = 1500.0
"""A driver who asks for more this fast, or for less, makes the wheel swing himself."""

MEAN_SHARE: Final = 0.97
"""Held is this much of the torque's mean, or all that the tyre carries if that is more."""
SLIDING_CARRIED_SHARE: Final = 0.95
LEAST_SHARE: Final = 0.6
"""A wheel that slides in the hold is to come back: it gets so much of what its tyre carries, and
at least so much of what was held before."""
SLIDING_SHARE: Final = 2.0
LOST_SHARE: Final = 4.0
"""Beyond so many slip references a held wheel slides, and is left to the law."""

SETTLING_S: Final = 0.05
HOLD_S: Final = 0.3
LONGEST_HOLD_S: Final = 2.0
LONGER: Final = 1.3
CALM_S: Final = 2.0
"""A hold is so much longer than the last one, unless so much time has passed since."""
GROWTH_S: Final = 0.7


class SwingGuard:
    """Takes the torque out of feedback where the loop begins to swing.

    Below what the tyre carries, wheel and driveline are stable by themselves:
    what they keep up, the loop feeds.  So after a few swings the torque is held,
    at its mean or what the tyre carries, until they have died away, and then bounded by a
    ceiling that grows until it binds no more.  If the loop swings again, it is
    held for longer.  What a stab at the pedal sets swinging has ``stab_rings_s``
    to die away before anything is counted.
    """

    def __init__(
        self, slip_reference: float, vehicle: Vehicle, period_s: float, stab_rings_s: float = 0.0
    ) -> None:
        self._slip_reference = slip_reference
        self._carried = CarriedForce(slip_reference, vehicle, period_s)
        self._rise = FrictionRise(slip_reference, period_s)
        self._period_s = period_s
        self._stab_rings_s = stab_rings_s
        self._settling = 1.0 - math.exp(-period_s / SETTLING_S)
        self._growth = math.exp(period_s / GROWTH_S)
        self._slip, self._torque, self._fed = (Swings(period_s) for _ in range(3))
        self._mean = SwingMean()
        self.reset()

    def reset(self) -> None:
        """Nothing swings."""
        self._forget_swings()
        self._carried.reset()
        self._rise.reset()
        self._asked_nm = 0.0  # by the driver, a tick ago
        self._level_nm = self._least_nm = 0.0  # what the ceiling settles at while it is held
        self._ceiling_nm = math.inf
        self._left_s = 0.0  # of the hold
        self._hold_s = HOLD_S
        self._calm_s = math.inf  # since the last hold began
        self._stabbed_s = math.inf  # since the driver last stabbed

    @property
    def holds(self) -> bool:
        """Whether the ceiling is the torque to send, whatever the law says."""
        return self._left_s > 0.0

    def ceiling_nm(self, wheel: WheelState, torque_ref_nm: float, sent_nm: float) -> float:
        """Most torque in [0, torque_ref_nm] that may follow ``sent_nm``; called once a tick."""
        self._observe(wheel, torque_ref_nm, sent_nm)
        if torque_ref_nm <= self._ceiling_nm:
            self._release()
        if self.holds:
            self._hold(wheel)
        elif self._swings():
            self._begin(sent_nm)
        else:
            grown_nm = self._growth * self._ceiling_nm
            self._ceiling_nm = grown_nm if grown_nm < torque_ref_nm else math.inf
        return min(self._ceiling_nm, torque_ref_nm)

    def _observe(self, wheel: WheelState, torque_ref_nm: float, sent_nm: float) -> None:
        self._calm_s += self._period_s
        kicked = self._rise.shows(wheel, self._carried.force_n)
        self._carried.observe(wheel)
        stab_nm = self._period_s * STAB_NMPS
        stabs = not 0.0 <= torque_ref_nm - self._asked_nm <= stab_nm
        self._stabbed_s = 0.0 if stabs else self._stabbed_s + self._period_s
        if self.holds or kicked or stabs or self._stabbed_s < self._stab_rings_s:
            self._forget_swings()  # what road or driver set swinging is no fault of the loop
        else:
            self._count(wheel, sent_nm)
        self._asked_nm = torque_ref_nm

    def _count(self, wheel: WheelState, sent_nm: float) -> None:
        motor_nm = wheel.motor_torque_nm
        torque_nm = motor_nm if -math.inf < motor_nm < math.inf else sent_nm
        speed_mps = max(wheel.vehicle_speed_mps, LEAST_SLIP_MPS)
        self._slip.update(wheel.slip_ratio, max(LEAST_SLIP_RATIO, LEAST_SLIP_MPS / speed_mps))
        self._torque.update(torque_nm, LEAST_NM)
        self._mean.add(sent_nm, turned=self._fed.update(torque_nm, FED_NM))

    def _swings(self) -> bool:
        fed = self._slip.turns >= TURNS and self._fed.turns >= TURNS - 1
        return fed or self._torque.turns >= TURNS

    def _begin(self, sent_nm: float) -> None:
        again = self._calm_s < CALM_S
        self._hold_s = min(LONGER * self._hold_s, LONGEST_HOLD_S) if again else HOLD_S
        self._left_s, self._calm_s = self._hold_s, 0.0
        mean_nm = min(MEAN_SHARE * self._mean.value, self._ceiling_nm)
        self._level_nm = max(mean_nm, self._carried.torque_nm)
        self._least_nm = LEAST_SHARE * self._level_nm
        self._ceiling_nm = max(self._level_nm, min(sent_nm, self._ceiling_nm))

    def _hold(self, wheel: WheelState) -> None:
        """Settle gently: near standstill a step of torque makes the tyre swing by itself."""
        self._left_s -= self._period_s
        if wheel.slip_ratio > SLIDING_SHARE * self._slip_reference:
            carried_nm = SLIDING_CARRIED_SHARE * self._carried.torque_nm
            self._level_nm = max(carried_nm, self._least_nm)
        if wheel.slip_ratio > LOST_SHARE * self._slip_reference:
            self._left_s = 0.0
        self._ceiling_nm += self._settling * (self._level_nm - self._ceiling_nm)

    def _release(self) -> None:
        """The driver asks for no more than the ceiling allows: nothing is held."""
        self._left_s, self._ceiling_nm = 0.0, math.inf

    def _forget_swings(self) -> None:
        for counter in (self._slip, self._torque, self._fed):
            counter.reset()
        self._mean.reset()
