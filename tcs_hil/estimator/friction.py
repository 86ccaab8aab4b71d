"""Friction under one driven wheel, from its tyre's force and slip, and how sure that is."""

from __future__ import annotations

import math
from typing import Final

from tcs_hil.model.tyre import Tyre
from tcs_hil.model.vehicle import Vehicle

LEARNING_S: Final = 0.05
FORGETTING_S: Final = 2.0
TELLING_SLIP: Final = 0.06
"""Below it a tyre's force tells its stiffness rather than its friction."""


class FrictionEstimate:
    """mu of one wheel: a low-pass of force over the force that mu 1 would give.

    It learns where the slip reaches into the curve's bend, and its confidence
    is the share of what it has learnt there; without news confidence fades.
    """

    def __init__(self, vehicle: Vehicle, period_s: float) -> None:
        self._tyre = Tyre(vehicle, math)
        self._friction_ratio = vehicle.friction_ratio
        self._learn = 1.0 - math.exp(-period_s / LEARNING_S)
        self._keep = math.exp(-period_s / FORGETTING_S)
        self.value_ratio = vehicle.friction_ratio  # until something is known
        self.confidence_ratio = 0.0

    def update(self, force_n: float, slip_ratio: float) -> None:
        """Learn from one tick."""
        self.confidence_ratio *= self._keep
        telling = min(max(slip_ratio / TELLING_SLIP - 0.5, 0.0) * 2.0, 1.0)
        if telling == 0.0 or not math.isfinite(force_n):
            return
        full_n = self._tyre.force_n(slip_ratio) / self._friction_ratio
        gain = self._learn * telling
        self.value_ratio += gain * (min(max(force_n / full_n, 0.0), 1.5) - self.value_ratio)
        self.confidence_ratio += gain * (1.0 - self.confidence_ratio)
