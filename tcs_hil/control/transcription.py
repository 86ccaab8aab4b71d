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

from tcs_hil.control.least_squares import gauss_newton
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.model.wheel import rk4, slip_dynamics, slip_ratio

NX = 3
"""State x = [s, omega, e_int]."""


@lru_cache(maxsize=8)
def gauss_newton_function(settings: ControlSettings, vehicle: Vehicle) -> Any:
    """CasADi function (x_0 (3,), U (N,), T_ref) -> cost in Nm², gradient (N,), Hessian (N, N).

    Building takes 0.1 s, so the wheels of a car share one.
    """
    x0, torque_ref = ca.SX.sym("x0", NX), ca.SX.sym("T_ref")
    plan = ca.SX.sym("U", settings.nmpc.horizon)
    residuals = _residuals(x0, plan, torque_ref, settings, vehicle)
    return gauss_newton("paper", x0, plan, torque_ref, residuals)


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
    """State [s, omega, e_int] one period later."""

    def rate(state: Any) -> Any:
        return wheel_rate(state, torque_nm, settings.slip_reference, car)

    return rk4(rate, x, settings.period_s, settings.nmpc.substeps)


def wheel_rate(state: Any, torque_nm: Any, slip_reference: Any, car: Vehicle) -> Any:
    """Time derivative of [s, omega, e_int]: Eq. (e_int) goes with the wheel's dynamics."""
    s_rate, omega_rate = slip_dynamics(state[0], state[1], torque_nm, car, ca)
    error = slip_reference - slip_ratio(state[0], state[1], car)
    return ca.vertcat(s_rate, omega_rate, error)
