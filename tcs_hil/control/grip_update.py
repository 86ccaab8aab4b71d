"""Online update of the predictor: between a bank for the believed road and one for ice."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from tcs_hil.control.bank_kmpc import BankOptimiser
from tcs_hil.control.plan import Plan, mixed
from tcs_hil.control.protocol import WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.bank import KoopmanBank
from tcs_hil.model.tyre import tyre_force_n
from tcs_hil.model.vehicle import Vehicle

FORGETTING = 0.03
"""Weight of the newest tick: 70 ms of memory."""

EXCITATION = 0.3
"""Share of the peak force the model must expect before a tick teaches anything."""

AGREEMENT = 0.5
"""Error of the regressed force, as a share of the expected, above which it is not believed."""

RELAXATION_M = 0.15


class GripEstimate:
    """Observed tyre force over the believed one: scalar least squares with forgetting.

    Bounded to [``least``, 1]: no grip beyond the model's is ever believed, which
    would raise the torque.  The believed force follows its slip over the
    relaxation length, as the real one does.  Without excitation the estimate
    stays; where a scaled force does not explain the observed one, it is 1 again.
    """

    def __init__(self, vehicle: Vehicle, period_s: float, least: float) -> None:
        self._vehicle = vehicle
        self._period_s = period_s
        self._least = least
        self._peak_n = vehicle.friction_ratio * vehicle.wheel_load_n * vehicle.tyre_d
        self.reset()

    def reset(self) -> None:
        """The road is as believed."""
        self.value = 1.0
        self._expected = 0.0
        self._product = self._square = self._energy = 0.0

    def update(self, wheel: WheelState) -> float:
        """Learn from one tick; returns the share of the believed grip."""
        static = float(tyre_force_n(wheel.slip_ratio, self._vehicle, math)) / self._peak_n
        self._expected += self._settling(wheel) * (static - self._expected)
        force = wheel.tyre_force_n / self._peak_n
        if math.isfinite(force) and self._expected > EXCITATION:
            self._product += FORGETTING * (self._expected * force - self._product)
            self._square += FORGETTING * (self._expected**2 - self._square)
            self._energy += FORGETTING * (force**2 - self._energy)
            self.value = self._regressed()
        return self.value

    def _regressed(self) -> float:
        slope = self._product / self._square
        error_square = self._energy - slope * self._product
        if error_square > AGREEMENT**2 * self._square:
            return 1.0
        return min(max(slope, self._least), 1.0)

    def _settling(self, wheel: WheelState) -> float:
        """Share of the way to the static force that one period brings."""
        rim_mps = wheel.wheel_speed_radps * self._vehicle.wheel_radius_m
        rolling_mps = math.sqrt(rim_mps * rim_mps + self._vehicle.slip_epsilon_m2ps2)
        return 1.0 - math.exp(-rolling_mps * self._period_s / RELAXATION_M)


class GripOptimiser:
    """Two banks side by side; what they predict and plan is mixed by the grip observed."""

    def __init__(self, settings: ControlSettings, banks: tuple[KoopmanBank, KoopmanBank]) -> None:
        believed, slippery = banks
        self._optimisers = (BankOptimiser(settings, believed), BankOptimiser(settings, slippery))
        vehicle = believed.provenance.settings.vehicle
        self._least = float(np.mean(slippery.provenance.settings.fleet.friction_ratio))
        self._least /= vehicle.friction_ratio
        self._grip = GripEstimate(vehicle, settings.period_s, self._least)
        self._weights = (1.0, 0.0)

    def observe(self, wheel: WheelState, integral_s: float) -> None:
        """The states of both are those at the instant ``wheel`` describes; learns the grip."""
        share = math.log(self._grip.update(wheel)) / math.log(self._least)
        self._weights = (1.0 - share, share)
        for law in self._optimisers:
            law.observe(wheel, integral_s)

    def roll_forward(self, torques_nm: Sequence[float], first_periods: float) -> None:
        """Carry both states through torques, the first for a part of a period, then one each."""
        for law in self._optimisers:
            law.roll_forward(torques_nm, first_periods)

    def plan(self, last_torque_nm: float, torque_ref_nm: float) -> Plan:
        """Best torques (N,) in Nm of those that have a say."""
        voices = [
            (law.plan(last_torque_nm, torque_ref_nm), weight)
            for law, weight in zip(self._optimisers, self._weights, strict=True)
            if weight > 0.0
        ]
        return mixed([plan for plan, _ in voices], [weight for _, weight in voices])

    def reset(self) -> None:
        """Forget everything, the grip too."""
        self._grip.reset()
        for law in self._optimisers:
            law.reset()
