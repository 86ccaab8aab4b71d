"""What the wheel speed does beyond its prediction: one scalar that keeps the bank offset-free."""

from __future__ import annotations

import math

from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.vehicle import Vehicle


class SpeedDisturbance:
    """A constant d: the one-period error of omega, integrated.

    Another road, another load or a grade shows up here.  Limited to what a tyre
    force of the static wheel load would do, and no single tick may claim more,
    so that neither a sensor fault nor a pause can invent a road.
    """

    def __init__(self, settings: ControlSettings, vehicle: Vehicle) -> None:
        self._gain = 1.0 - math.exp(-settings.period_s / settings.default.kmpc.observer_time_s)
        torque_nm = vehicle.wheel_load_n * vehicle.wheel_radius_m
        self._limit_radps = settings.period_s * torque_nm / vehicle.wheel_inertia_kgm2
        self.value_radps = 0.0

    def learn(self, surplus_radps: float) -> None:
        """Take one tick's wheel speed beyond the bare prediction; NaN teaches nothing."""
        innovation = surplus_radps - self.value_radps
        if math.isfinite(innovation):
            value = self.value_radps + self._gain * self._limited(innovation)
            self.value_radps = self._limited(value)

    def reset(self) -> None:
        """Nothing is known."""
        self.value_radps = 0.0

    def _limited(self, value: float) -> float:
        return min(max(value, -self._limit_radps), self._limit_radps)
