"""The force the tyre makes beyond its model: one scalar that keeps predictions offset-free."""

from __future__ import annotations

import math

from tcs_hil.control.driveline import CREEP_MPS
from tcs_hil.control.protocol import WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.tyre import Tyre
from tcs_hil.model.vehicle import Vehicle


class ForceDisturbance:
    """dF of one wheel, N: observed tyre force less the model's, low-passed.

    The model's force follows its slip over the relaxation length, as in the
    prediction; without an observed force nothing is learnt.  Limited to the
    static wheel load, so that no sensor fault can invent more than a road.
    """

    def __init__(self, settings: ControlSettings, vehicle: Vehicle, memory_s: float) -> None:
        self._tyre = Tyre(vehicle, math)
        self._radius_m = vehicle.wheel_radius_m
        self._limit_n = vehicle.wheel_load_n
        line = settings.default.driveline
        self._sliding_m = line.tyre_sliding_m
        self._bent_m = line.tyre_relaxation_m - line.tyre_sliding_m
        self._period_s = settings.period_s
        self._gain = 1.0 - math.exp(-settings.period_s / memory_s)
        self._modelled_n = 0.0
        self.value_n = 0.0

    def update(self, wheel: WheelState) -> float:
        """Learn from one tick; returns the best guess of the tyre's force now, N."""
        static_n = float(self._tyre.force_n(wheel.slip_ratio))
        self._modelled_n += self._settling(wheel) * (static_n - self._modelled_n)
        if not math.isfinite(wheel.tyre_force_n):
            return self._modelled_n + self.value_n
        surplus_n = wheel.tyre_force_n - self._modelled_n
        value_n = self.value_n + self._gain * (surplus_n - self.value_n)
        self.value_n = min(max(value_n, -self._limit_n), self._limit_n)
        return self._modelled_n + self.value_n

    def reset(self) -> None:
        """The tyre is as in its model."""
        self._modelled_n = 0.0
        self.value_n = 0.0

    def _settling(self, wheel: WheelState) -> float:
        """Share of the way to the static force that one period brings."""
        rim_mps = wheel.wheel_speed_radps * self._radius_m
        rolling_mps = math.sqrt(rim_mps * rim_mps + CREEP_MPS * CREEP_MPS)
        relaxation_m = self._sliding_m + self._bent_m * float(
            self._tyre.secant_ratio(wheel.slip_ratio)
        )
        return 1.0 - math.exp(-rolling_mps * self._period_s / relaxation_m)
