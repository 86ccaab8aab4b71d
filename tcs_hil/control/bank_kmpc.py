"""The default Koopman MPC: a bank over speed, delay rolled out, offset-free by a disturbance."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.bank_core import bank_core
from tcs_hil.control.bank_problem import NX
from tcs_hil.control.plan import Plan
from tcs_hil.control.protocol import WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.control.speed_disturbance import SpeedDisturbance
from tcs_hil.model.bank import KoopmanBank
from tcs_hil.model.observables import NZ, Sample, lift_one

FloatArray = NDArray[np.float64]


class BankOptimiser:
    """Predicts and plans with the one or two bands around the vehicle's speed.

    In between, the plans of both are mixed like their predictions: the command
    is continuous in speed, and every quadratic program keeps the factor it was
    set up with.
    """

    def __init__(self, settings: ControlSettings, bank: KoopmanBank) -> None:
        self._bank = bank
        self._vehicle = bank.provenance.settings.vehicle
        self._core = bank_core(settings, bank)
        self._disturbance = SpeedDisturbance(settings, self._vehicle)
        self.reset()

    def reset(self) -> None:
        """Forget the last plan, the last sample and the disturbance."""
        self._before: Sample | None = None
        self._expected_radps = math.nan
        self._sent_nm = 0.0
        self._disturbance.reset()
        self._core.reset()

    def state(self, wheel: WheelState, integral_s: float) -> FloatArray:
        """State x (NX,) at the instant ``wheel`` describes; learns the disturbance."""
        now = self._sample(wheel)
        x = np.empty(NX)
        x[:NZ] = lift_one(now, self._before or now, self._vehicle)
        self._disturbance.learn(wheel.wheel_speed_radps - self._expected_radps)
        x[NZ:] = integral_s, self._disturbance.value_radps
        self._core.settle(self._bank.shares(wheel.vehicle_speed_mps))
        self._expected_radps = self._core.wheel_speed_after(x)
        self._before = now
        return x

    def advance(self, state: FloatArray, torque_nm: float, periods: float) -> FloatArray:
        """State (NX,) after ``periods`` in (0, 1] periods of a torque; linear within a period."""
        return self._core.after(state, torque_nm, periods)

    def plan(self, state: FloatArray, last_torque_nm: float, torque_ref_nm: float) -> Plan:
        """Best torques (N,) in Nm within [0, torque_ref_nm]."""
        self._sent_nm = last_torque_nm
        return self._core.plan(state, last_torque_nm, torque_ref_nm)

    def _sample(self, wheel: WheelState) -> Sample:
        return Sample(
            wheel.slip_speed_mps,
            wheel.wheel_speed_radps,
            wheel.motor_speed_radps / self._vehicle.gear_ratio,
            # Without a motor on the bus, what was sent to it is the best guess.
            self._sent_nm if math.isnan(wheel.motor_torque_nm) else wheel.motor_torque_nm,
        )
