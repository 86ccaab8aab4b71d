"""The nonlinear MPC as a least-squares problem in CasADi: single shooting over N torques.

The paper's cost, Eq. (opt_NMPC_cost), is sampled at the ends of the N periods.
Every term then carries T_s, and dividing all of them by T_s w_u changes no
minimiser: the residuals come out in Nm and the Hessian close to the identity.

Derivatives are taken of one period, by its first state and its torque, and chained
over the horizon: those by x_0, which the next tick's guess needs, then cost nothing more.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import casadi as ca

from tcs_hil.control.least_squares import gauss_newton_model
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.model.wheel import rk4, slip_dynamics, slip_ratio

NX = 3
"""State x = [s, omega, e_int]."""


@lru_cache(maxsize=8)
def gauss_newton_function(settings: ControlSettings, vehicle: Vehicle) -> Any:
    """CasADi function (x_0 (3,), U (N,), T_ref) -> cost, gradient, Hessian, drift; for `Tracked`.

    The cost is in Nm².  Building takes 0.1 s, so the wheels of a car share one.
    """
    x0, torque_ref = ca.SX.sym("x0", NX), ca.SX.sym("T_ref")
    plan = ca.SX.sym("U", settings.nmpc.horizon)
    residuals, jacobian = _shoot(x0, torque_ref, plan, _period_function(settings, vehicle))
    by_given, by_plan = jacobian[:, : NX + 1], jacobian[:, NX + 1 :]
    outputs = [*gauss_newton_model(residuals, by_plan), 2.0 * ca.densify(by_plan.T @ by_given)]
    return ca.Function("paper", [x0, plan, torque_ref], outputs, {"cse": True})


def _shoot(x0: Any, torque_ref: Any, plan: Any, period: Any) -> tuple[Any, Any]:
    """Residuals (3 N,) of all periods and their Jacobian by [x_0, T_ref, U]."""
    variables = ca.vertcat(x0, torque_ref, plan)
    x, x_slope = x0, ca.jacobian(x0, variables)
    residuals, rows = [], []
    for k in range(plan.numel()):
        inputs = ca.vertcat(plan[k], torque_ref)
        outcome, by_x, by_inputs = period(x, inputs)
        slope = by_x @ x_slope + by_inputs @ ca.jacobian(inputs, variables)
        x, x_slope = outcome[:NX], slope[:NX, :]
        residuals.append(outcome[NX:])
        rows.append(slope[NX:, :])
    return ca.vertcat(*residuals), ca.vertcat(*rows)


def _period_function(settings: ControlSettings, vehicle: Vehicle) -> Any:
    """CasADi function (x, [u, T_ref]) -> [next x, residuals] (6,) and its Jacobians by both."""
    x, inputs = ca.SX.sym("x", NX), ca.SX.sym("u_T_ref", 2)
    after = _advance(x, inputs[0], settings, vehicle)
    outcome = ca.vertcat(after, _residuals(after, inputs, settings, vehicle))
    outputs = [outcome, ca.jacobian(outcome, x), ca.jacobian(outcome, inputs)]
    return ca.Function("period", [x, inputs], outputs, {"cse": True})


def _residuals(x: Any, inputs: Any, settings: ControlSettings, car: Vehicle) -> Any:
    """Residuals (3,) in Nm of a period that ends in x: slip error, integral, torque reduction."""
    tuning, (torque, torque_ref) = settings.nmpc, ca.vertsplit(inputs)
    slip_gain = math.sqrt(tuning.weight_slip / tuning.weight_reduction)
    integral_gain = math.sqrt(tuning.weight_integral / tuning.weight_reduction)
    error = settings.slip_reference - slip_ratio(x[0], x[1], car)
    return ca.vertcat(slip_gain * error, integral_gain * x[2], torque_ref - torque)


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
