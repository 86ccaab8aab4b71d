"""The nonlinear MPC as a least-squares problem in CasADi: single shooting over N torques.

The paper's cost, Eq. (opt_NMPC_cost), is sampled at the ends of the N periods.
Every term then carries T_s, and dividing all of them by T_s w_u changes no
minimiser: the residuals come out in Nm and the Hessian close to the identity.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.model.wheel import rk4, slip_dynamics, slip_ratio

FloatArray = NDArray[np.float64]

NX = 3
"""State x = [s, omega, e_int]."""


@lru_cache(maxsize=8)
def gauss_newton_function(settings: ControlSettings, vehicle: Vehicle) -> Any:
    """CasADi function (x_0 (3,), U (N,), T_ref) -> cost, gradient (N,), Hessian (N, N).

    The Hessian is Gauss-Newton's, 2 J'J.  Building takes 0.1 s, so the wheels of
    a car share one.
    """
    x0, torque_ref = ca.SX.sym("x0", NX), ca.SX.sym("T_ref")
    plan = ca.SX.sym("U", settings.nmpc.horizon)
    r = _residuals(x0, plan, torque_ref, settings, vehicle)
    jacobian = ca.jacobian(r, plan)
    outputs = [
        ca.sumsqr(r),
        2.0 * ca.densify(jacobian.T @ r),
        2.0 * ca.densify(jacobian.T @ jacobian),
    ]
    return ca.Function("gauss_newton", [x0, plan, torque_ref], outputs, {"cse": True})


def _residuals(x0: Any, plan: Any, torque_ref: Any, settings: ControlSettings, car: Vehicle) -> Any:
    """Residuals (3 N,) in Nm: slip error, integral and torque reduction of each period."""
    tuning, x, residuals = settings.nmpc, x0, []
    slip_gain = math.sqrt(tuning.weight_slip / tuning.weight_reduction)
    integral_gain = math.sqrt(tuning.weight_integral / tuning.weight_reduction)
    for k in range(tuning.horizon):
        x = _advance(x, plan[k], settings, car)
        error = settings.slip_reference - slip_ratio(x[0], x[1], car)
        residuals += [slip_gain * error, integral_gain * x[2], torque_ref - plan[k]]
    return ca.vertcat(*residuals)


def _advance(x: Any, torque_nm: Any, settings: ControlSettings, car: Vehicle) -> Any:
    """State [s, omega, e_int] one period later, Eq. (e_int) integrated along."""

    def rate(state: Any) -> Any:
        s_rate, omega_rate = slip_dynamics(state[0], state[1], torque_nm, car, ca)
        error = settings.slip_reference - slip_ratio(state[0], state[1], car)
        return ca.vertcat(s_rate, omega_rate, error)

    return rk4(rate, x, settings.period_s, settings.nmpc.substeps)


class Linearisation:
    """The function above on preallocated memory: no allocation and no copy per call."""

    def __init__(self, settings: ControlSettings, vehicle: Vehicle) -> None:
        n = settings.nmpc.horizon
        self._x0, self._plan, self._torque_ref = np.zeros(NX), np.zeros(n), np.zeros(1)
        self._cost = np.zeros(1)
        self.gradient = np.zeros(n)  # (N,), at the last plan
        self.hessian = np.zeros((n, n))  # (N, N), at the last plan
        self._buffer, self._evaluate = gauss_newton_function(settings, vehicle).buffer()
        for index, memory in enumerate((self._x0.data, self._plan.data, self._torque_ref.data)):
            self._buffer.set_arg(index, memory)
        for index, memory in enumerate((self._cost.data, self.gradient.data, self.hessian.data)):
            self._buffer.set_res(index, memory)

    def start_from(self, x0: tuple[float, float, float], torque_ref_nm: float) -> None:
        """Set the measured state [s, omega, e_int] and the driver's request."""
        self._x0[:] = x0
        self._torque_ref[0] = torque_ref_nm

    def at(self, plan: FloatArray) -> float:
        """Cost of the plan (N,) in Nm²; ``gradient`` and ``hessian`` follow it."""
        self._plan[:] = plan
        self._evaluate()
        return float(self._cost[0])
