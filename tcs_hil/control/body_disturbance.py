"""What the body gains beyond this wheel's push: the grade, and the other wheel on its own road."""

from __future__ import annotations

import math
from typing import Final

from tcs_hil.control.protocol import WheelState
from tcs_hil.model.vehicle import Vehicle

MEMORY_S: Final = 0.15
"""Shorter than a road lasts, longer than a tyre rings: at walking pace that is no acceleration."""

LIMIT_MPS2: Final = 5.0
"""A wheel on ice beside one on asphalt, downhill: no road and no car does more."""


class BodyDisturbance:
    """The body's acceleration less 2 F / m, the believed one, low-passed; m/s².

    The model has one wheel and gives the other the same road.  On split friction,
    or downhill, the body outruns that, and with it the wheel speed that is right.
    Without an acceleration or a tyre force nothing is learnt.
    """

    def __init__(self, vehicle: Vehicle, period_s: float) -> None:
        self._per_force = 2.0 / vehicle.mass_kg
        self._gain = 1.0 - math.exp(-period_s / MEMORY_S)
        self.value_mps2 = 0.0

    def learn(self, wheel: WheelState) -> None:
        """Take one tick."""
        surplus_mps2 = wheel.vehicle_accel_mps2 - self._per_force * wheel.tyre_force_n
        if -math.inf < surplus_mps2 < math.inf:
            bounded_mps2 = min(max(surplus_mps2, -LIMIT_MPS2), LIMIT_MPS2)
            self.value_mps2 += self._gain * (bounded_mps2 - self.value_mps2)

    def reset(self) -> None:
        """The body does what the model says."""
        self.value_mps2 = 0.0
