"""The default Koopman MPC: a bank over speed, delay rolled out, offset-free by a disturbance."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

import numpy as np
from msgspec.structs import replace

from tcs_hil.control.bank_core import FloatArray, bank_core
from tcs_hil.control.force_disturbance import ForceDisturbance
from tcs_hil.control.plan import Plan
from tcs_hil.control.protocol import WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.control.speed_disturbance import SpeedDisturbance
from tcs_hil.model.bank import KoopmanBank

FORCE_SHARE: Final = 0.17
FORCE_S: Final = 0.02
FORCE_SLOW_MPS: Final = 3.0
FORCE_FAST_MPS: Final = 5.5
"""So much of the force that the tyre lacks is foreseen to go on, low-passed over this time: nothing
up to the first speed, where it would feed the tyre's ring, the whole share from the second."""


class BankOptimiser:
    """Predicts and plans with the one or two bands around the vehicle's speed.

    In between, the plans of both are mixed like their predictions: the command
    is continuous in speed, and every quadratic program keeps the factor it was
    set up with.
    """

    def __init__(self, settings: ControlSettings, bank: KoopmanBank) -> None:
        self._core = bank_core(settings, bank)
        road_ratio = float(np.mean(bank.provenance.settings.fleet.friction_ratio))
        vehicle = replace(bank.provenance.settings.vehicle, friction_ratio=road_ratio)
        self._speed = SpeedDisturbance(settings, vehicle)
        self._force = ForceDisturbance(settings, vehicle, FORCE_S)
        inertia_kgm2 = settings.default.driveline.wheel_inertia_kgm2
        self._radps_per_n = -settings.period_s * vehicle.wheel_radius_m / inertia_kgm2
        self.reset()

    @property
    def state(self) -> FloatArray:
        """State x (NX,) as the last call has left it; valid until the next."""
        return self._core.x

    def reset(self) -> None:
        """Forget the last plan, the last sample and what disturbs."""
        self._expected_radps = math.nan
        self._sent_nm = 0.0
        self._speed.reset()
        self._force.reset()
        self._core.reset()

    def observe(self, wheel: WheelState, integral_s: float) -> None:
        """The state is the one at the instant ``wheel`` describes; learns what disturbs it."""
        self._speed.learn(wheel.wheel_speed_radps - self._expected_radps)
        self._force.update(wheel)
        # Without a motor on the bus, what was sent to it is the best guess.
        unknown = math.isnan(wheel.motor_torque_nm)
        torque_nm = self._sent_nm if unknown else wheel.motor_torque_nm
        self._expected_radps = self._core.observe(
            wheel, torque_nm, integral_s, self._disturbance_radps(wheel)
        )

    def _disturbance_radps(self, wheel: WheelState) -> float:
        """What the wheel gains in a period beyond its prediction.

        Of a tyre that pushes less than believed the error over one period says
        little, because the change of the motor's speed in z tells that force for
        this period, and for no other.
        """
        way = (wheel.vehicle_speed_mps - FORCE_SLOW_MPS) / (FORCE_FAST_MPS - FORCE_SLOW_MPS)
        brisk = min(max(way, 0.0), 1.0)
        lacking_radps = self._radps_per_n * self._force.value_n
        return self._speed.value_radps + FORCE_SHARE * brisk * lacking_radps

    def roll_forward(self, torques_nm: Sequence[float], first_periods: float) -> None:
        """Carry the state through torques, the first for a part of a period, then one each."""
        self._core.roll_forward(torques_nm, first_periods)

    def plan(self, last_torque_nm: float, torque_ref_nm: float) -> Plan:
        """Best torques (N,) in Nm within [0, torque_ref_nm]."""
        self._sent_nm = last_torque_nm
        return self._core.plan(last_torque_nm, torque_ref_nm)
