"""The default Koopman MPC: a bank over speed, delay rolled out, offset-free by a disturbance."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.bank_problem import NX, band_problems
from tcs_hil.control.plan import Plan
from tcs_hil.control.protocol import SolveStatus, WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.control.speed_disturbance import SpeedDisturbance
from tcs_hil.model.bank import KoopmanBank
from tcs_hil.model.observables import NZ, Observable, Sample, lift_one

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
        self._systems, self._problems = band_problems(bank, settings)
        self._disturbance = SpeedDisturbance(settings, self._vehicle)
        self.reset()

    def reset(self) -> None:
        """Forget the last plan, the last sample and the disturbance."""
        self._shares = self._bank.shares(0.0)
        self._a, self._b = np.eye(NX), np.zeros(NX)
        self._before: Sample | None = None
        self._expected_radps = math.nan
        self._sent_nm = 0.0
        self._disturbance.reset()
        for problem in self._problems:
            problem.reset()

    def state(self, wheel: WheelState, integral_s: float) -> FloatArray:
        """State x (NX,) at the instant ``wheel`` describes; learns the disturbance."""
        now = self._sample(wheel)
        x = np.empty(NX)
        x[:NZ] = lift_one(now, self._before or now, self._vehicle)
        self._disturbance.learn(wheel.wheel_speed_radps - self._expected_radps)
        x[NZ:] = integral_s, self._disturbance.value_radps
        self._interpolate(wheel.vehicle_speed_mps)
        self._expected_radps = float(self._a[Observable.WHEEL_SPEED, :NZ] @ x[:NZ])
        self._before = now
        return x

    def advance(self, state: FloatArray, torque_nm: float, periods: float) -> FloatArray:
        """State (NX,) after ``periods`` in (0, 1] periods of a torque; linear within a period."""
        after: FloatArray = self._a @ state + self._b * torque_nm
        return after if periods == 1.0 else state + periods * (after - state)

    def plan(self, state: FloatArray, last_torque_nm: float, torque_ref_nm: float) -> Plan:
        """Best torques (N,) in Nm within [0, torque_ref_nm]."""
        self._sent_nm = last_torque_nm
        plans = [
            self._problems[band].solve(state, last_torque_nm, torque_ref_nm)
            for band, _ in self._shares
        ]
        return mixed(plans, [weight for _, weight in self._shares])

    def _sample(self, wheel: WheelState) -> Sample:
        return Sample(
            wheel.slip_speed_mps,
            wheel.wheel_speed_radps,
            wheel.motor_speed_radps / self._vehicle.gear_ratio,
            # Without a motor on the bus, what was sent to it is the best guess.
            self._sent_nm if math.isnan(wheel.motor_torque_nm) else wheel.motor_torque_nm,
        )

    def _interpolate(self, speed_mps: float) -> None:
        self._shares = self._bank.shares(speed_mps)
        (band, weight), *rest = self._shares
        self._a, self._b = weight * self._systems[band].a, weight * self._systems[band].b[:, 0]
        for other, share in rest:
            self._a += share * self._systems[other].a
            self._b += share * self._systems[other].b[:, 0]


def mixed(plans: list[Plan], weights: list[float]) -> Plan:
    """Weighted mean of plans; as bad as the worst of them, as long as all together."""
    inputs = sum(weight * plan.inputs for plan, weight in zip(plans, weights, strict=True))
    status = max((plan.status for plan in plans), default=SolveStatus.FAILED)
    return Plan(np.asarray(inputs), status, sum(plan.iterations for plan in plans))
