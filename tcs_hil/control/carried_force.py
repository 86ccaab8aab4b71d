"""What a driven tyre was seen to carry, as the torque of its motor that makes as much."""

from __future__ import annotations

import math
from typing import Final

from tcs_hil.control.protocol import WheelState
from tcs_hil.model.vehicle import Vehicle

FORCE_S: Final = 0.05


class CarriedForce:
    """The tyre's force, low-passed over 50 ms and kept while it tells nothing new.

    Only a tyre that slides tells the most it carries; one that sticks, at least so much.
    """

    def __init__(self, slip_reference: float, vehicle: Vehicle, period_s: float) -> None:
        self._slip_reference = slip_reference
        self._arm_m = vehicle.wheel_radius_m / vehicle.gear_ratio
        self._gain = 1.0 - math.exp(-period_s / FORCE_S)
        self.reset()

    @property
    def torque_nm(self) -> float:
        """At the motor; 0 before anything was seen."""
        return self.force_n * self._arm_m

    def observe(self, wheel: WheelState) -> None:
        """See the wheel of one tick; a force nobody knows teaches nothing."""
        slides = wheel.slip_ratio > self._slip_reference
        if slides or wheel.tyre_force_n > self.force_n:
            surplus_n = wheel.tyre_force_n - self.force_n
            self.force_n += self._gain * surplus_n if math.isfinite(surplus_n) else 0.0

    def reset(self) -> None:
        """Nothing is known of the road."""
        self.force_n = 0.0  # 0 before anything was seen
