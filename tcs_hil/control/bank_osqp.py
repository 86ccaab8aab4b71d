"""The core of the default Koopman MPC in Python: the bands' problems on OSQP."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.bank_problem import NX, UNIT_NM, BandCost, bands_of
from tcs_hil.control.plan import Plan, mixed
from tcs_hil.control.qp import OsqpBox
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.bank import KoopmanBank, Share
from tcs_hil.model.observables import NZ, Observable

FloatArray = NDArray[np.float64]

TOLERANCE = 5e-6
"""Of the solver, in its unit: plans are then exact to half a bit of the limit on the bus."""


class OsqpBank:
    """Systems and problems of all bands, and the one or two in charge."""

    def __init__(self, settings: ControlSettings, bank: KoopmanBank) -> None:
        bands = bands_of(bank, settings)
        self._systems = [band.system for band in bands]
        self._problems = [BandProblem(band.cost) for band in bands]
        self._shares: Sequence[Share] = ()
        self._a, self._b = np.eye(NX), np.zeros(NX)  # mixed

    def settle(self, shares: Sequence[Share]) -> None:
        """From now on these one or two bands predict and plan, mixed by weight."""
        self._shares = shares
        (band, weight), *rest = shares
        self._a, self._b = weight * self._systems[band].a, weight * self._systems[band].b[:, 0]
        for other, share in rest:
            self._a += share * self._systems[other].a
            self._b += share * self._systems[other].b[:, 0]

    def wheel_speed_after(self, state: FloatArray) -> float:
        """Wheel speed in rad/s one period after a state (NX,), without torque or disturbance."""
        return float(self._a[Observable.WHEEL_SPEED, :NZ] @ state[:NZ])

    def after(self, state: FloatArray, torque_nm: float, periods: float) -> FloatArray:
        """State (NX,) after ``periods`` in (0, 1] periods of a torque; linear within a period."""
        after: FloatArray = self._a.dot(state) + self._b * torque_nm
        return after if periods == 1.0 else state + periods * (after - state)

    def plan(self, state: FloatArray, last_torque_nm: float, torque_ref_nm: float) -> Plan:
        """Best torques (N,) in Nm within [0, torque_ref_nm]."""
        plans = [
            self._problems[band].solve(state, last_torque_nm, torque_ref_nm)
            for band, _ in self._shares
        ]
        return mixed(plans, [weight for _, weight in self._shares])

    def reset(self) -> None:
        """Forget the last plans."""
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
        return plan._replace(inputs=plan.inputs * UNIT_NM)

    def reset(self) -> None:
        """Forget the last solution."""
        self._qp.reset()
