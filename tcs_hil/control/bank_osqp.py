"""The core of the default Koopman MPC in Python: the bands' problems on OSQP."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.bank_problem import DISTURBANCE, INTEGRAL, NX, UNIT_NM, BandCost, bands_of
from tcs_hil.control.plan import Plan, mixed
from tcs_hil.control.protocol import WheelState
from tcs_hil.control.qp import OsqpBox
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.bank import KoopmanBank, Share
from tcs_hil.model.observables import NZ, Observable, Sample, lift_one

FloatArray = NDArray[np.float64]

TOLERANCE = 5e-6
"""Of the solver, in its unit: plans are then exact to half a bit of the limit on the bus."""


class OsqpBank:
    """Systems and problems of all bands, the one or two in charge, and the state."""

    def __init__(self, settings: ControlSettings, bank: KoopmanBank) -> None:
        bands = bands_of(bank, settings)
        self._systems = [band.system for band in bands]
        self._problems = [BandProblem(band.cost) for band in bands]
        self._bank, self._vehicle = bank, bank.provenance.settings.vehicle
        self._before: Sample | None = None
        self._shares: Sequence[Share] = ()
        self._a, self._b = np.eye(NX), np.zeros(NX)  # mixed
        self.x = np.zeros(NX)

    def observe(
        self, wheel: WheelState, torque_nm: float, integral_s: float, disturbance_radps: float
    ) -> float:
        """Set x to what is seen now; returns the wheel speed expected one period later."""
        motor_radps = wheel.motor_speed_radps / self._vehicle.gear_ratio
        now = Sample(wheel.slip_speed_mps, wheel.wheel_speed_radps, motor_radps, torque_nm)
        self.x[:NZ] = lift_one(now, self._before or now, self._vehicle)
        self.x[INTEGRAL], self.x[DISTURBANCE] = integral_s, disturbance_radps
        self._before = now
        self._settle(self._bank.shares(wheel.vehicle_speed_mps))
        return float(self._a[Observable.WHEEL_SPEED, :NZ].dot(self.x[:NZ]))

    def roll_forward(self, torques_nm: Sequence[float], first_periods: float) -> None:
        """Carry x through torques, the first for a part of a period; linear within a period."""
        periods = first_periods
        for torque_nm in torques_nm:
            after = self._a.dot(self.x) + self._b * torque_nm
            self.x += periods * (after - self.x)
            periods = 1.0

    def plan(self, last_torque_nm: float, torque_ref_nm: float) -> Plan:
        """Best torques (N,) in Nm within [0, torque_ref_nm]."""
        plans = [
            self._problems[band].solve(self.x, last_torque_nm, torque_ref_nm)
            for band, _ in self._shares
        ]
        return mixed(plans, [weight for _, weight in self._shares])

    def _settle(self, shares: Sequence[Share]) -> None:
        """From now on these one or two bands predict and plan, mixed by weight."""
        self._shares = shares
        (band, weight), *rest = shares
        self._a, self._b = weight * self._systems[band].a, weight * self._systems[band].b[:, 0]
        for other, share in rest:
            self._a += share * self._systems[other].a
            self._b += share * self._systems[other].b[:, 0]

    def reset(self) -> None:
        """Forget the last sample and the last plans."""
        self._before = None
        for problem in self._problems:
            problem.reset()


class BandProblem:
    """One band's quadratic program."""

    def __init__(self, cost: BandCost) -> None:
        self._cost = cost
        self._qp = OsqpBox(cost.hessian, tolerance=TOLERANCE)

    def solve(self, state: FloatArray, last_torque_nm: float, torque_ref_nm: float) -> Plan:
        """Torques (N,) in Nm from x (NX,) on, warm from the last solution."""
        cost = self._cost
        gradient = cost.gradient_map.dot(state) - cost.reduction_pull * torque_ref_nm
        gradient[0] -= cost.change_pull * last_torque_nm
        plan = self._qp.solve(gradient, 0.0, torque_ref_nm / UNIT_NM)
        return Plan(plan.inputs * UNIT_NM, plan.status, plan.iterations)

    def reset(self) -> None:
        """Forget the last solution."""
        self._qp.reset()
