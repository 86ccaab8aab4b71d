"""The nonlinear MPC as a least-squares problem in CasADi: single shooting over N torques.

The paper's cost, Eq. (opt_NMPC_cost), is sampled at the ends of the N periods.
Every term then carries T_s, and dividing all of them by T_s w_u changes no
minimiser: the residuals come out in Nm and the Hessian close to the identity.

Derivatives are taken of one period, by its first state and its torque, and chained
over the horizon: those by x_0, which the next tick's guess needs, then cost nothing more.

A period is shot in y = [omega, momentum, e_int] instead of x = [s, omega, e_int].
The momentum of wheel and car, J omega + (m/4) R v, changes by the motor's torque
alone, so half of y's derivatives are constants, which CasADi folds; and Runge-Kutta
keeps linear invariants, so x is the same to rounding.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import casadi as ca

from tcs_hil.control.least_squares import gauss_newton_model
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.tyre import slip_ratio
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.model.wheel import rk4, slip_dynamics

NX = 3
"""State x = [s, omega, e_int]."""


@lru_cache(maxsize=8)
def gauss_newton_function(settings: ControlSettings, vehicle: Vehicle) -> Any:
    """CasADi function (x_0 (3,), U (N,), T_ref) -> cost, gradient, Hessian, drift; for `Tracked`.

    The cost is in Nm².  The wheels of a car share one.
    """
    x0, torque_ref = ca.SX.sym("x0", NX), ca.SX.sym("T_ref")
    plan = ca.SX.sym("U", settings.nmpc.horizon)
    residuals, jacobian = _shoot(x0, torque_ref, plan, settings, vehicle)
    by_given, by_plan = jacobian[:, : NX + 1], jacobian[:, NX + 1 :]
    outputs = [*gauss_newton_model(residuals, by_plan), 2.0 * ca.densify(by_plan.T @ by_given)]
    return ca.Function("paper", [x0, plan, torque_ref], outputs, {"cse": True})


def _shoot(x0: Any, torque_ref: Any, plan: Any, settings: ControlSettings, car: Vehicle) -> Any:
    """Residuals (3 N,) of all periods and their Jacobian by [x_0, T_ref, U]."""
    period, residual = _period_function(settings, car), _residual_function(settings, car)
    variables, y = ca.vertcat(x0, torque_ref, plan), _with_momentum(x0, car)
    slope, residuals, rows = ca.jacobian(y, variables), [], []
    for k in range(plan.numel()):
        inputs = ca.vertcat(plan[k], torque_ref)
        y, by_y, by_torque = period(y, plan[k])
        slope = by_y @ slope + by_torque @ ca.jacobian(plan[k], variables)
        errors, by_y, by_inputs = residual(y, inputs)
        residuals.append(errors)
        rows.append(by_y @ slope + by_inputs @ ca.jacobian(inputs, variables))
    return ca.vertcat(*residuals), ca.vertcat(*rows)


def _period_function(settings: ControlSettings, car: Vehicle) -> Any:
    """CasADi function (y, torque) -> y one period later and its derivatives by both.

    The derivatives (3, 4) go through the same Runge-Kutta steps as y.
    """
    y, torque = ca.SX.sym("y", NX), ca.SX.sym("u")
    rate = _derived(_rate(y, torque, settings, car), y, torque)

    def rates(columns: Any) -> Any:
        y_rate, by_y, by_torque = rate(columns[:, 0], torque)
        return ca.horzcat(y_rate, by_y @ columns[:, 1:] + by_torque @ ca.SX([[0, 0, 0, 1]]))

    start = ca.horzcat(y, ca.SX.eye(NX), ca.SX(NX, 1))
    after = rk4(rates, start, settings.period_s, settings.nmpc.substeps)
    return ca.Function("period", [y, torque], ca.horzsplit(after, [0, 1, NX + 1, NX + 2]))


def _rate(y: Any, torque_nm: Any, settings: ControlSettings, car: Vehicle) -> Any:
    """Time derivative of [omega, momentum, e_int]."""
    rate = wheel_rate(_with_slip_speed(y, car), torque_nm, settings.slip_reference, car)
    return ca.vertcat(rate[1], car.gear_ratio * torque_nm, rate[2])


def _residual_function(settings: ControlSettings, car: Vehicle) -> Any:
    """CasADi function (y, [u, T_ref]) -> residuals (3,) in Nm of a period that ends in y.

    They are slip error, integral and torque reduction; their derivatives by both follow.
    """
    y, inputs, tuning = ca.SX.sym("y", NX), ca.SX.sym("u_T_ref", 2), settings.nmpc
    s, omega, integral = ca.vertsplit(_with_slip_speed(y, car))
    slip_gain = math.sqrt(tuning.weight_slip / tuning.weight_reduction)
    integral_gain = math.sqrt(tuning.weight_integral / tuning.weight_reduction)
    error = settings.slip_reference - slip_ratio(s, omega, car)
    reduction = inputs[1] - inputs[0]
    return _derived(ca.vertcat(slip_gain * error, integral_gain * integral, reduction), y, inputs)


def _derived(value: Any, *by: Any) -> Any:
    """CasADi function of some variables -> a value and its Jacobians by each of them."""
    return ca.Function("derived", by, [value, *(ca.jacobian(value, each) for each in by)])


def _with_momentum(x: Any, car: Vehicle) -> Any:
    """[omega, momentum in Nms, e_int] of [s, omega, e_int]."""
    speed_mps = x[1] * car.wheel_radius_m - x[0]
    car_part = car.mass_kg / 4.0 * car.wheel_radius_m * speed_mps
    return ca.vertcat(x[1], car.wheel_inertia_kgm2 * x[1] + car_part, x[2])


def _with_slip_speed(y: Any, car: Vehicle) -> Any:
    """[s, omega, e_int] of [omega, momentum in Nms, e_int]."""
    car_part = y[1] - car.wheel_inertia_kgm2 * y[0]
    speed_mps = car_part / (car.mass_kg / 4.0 * car.wheel_radius_m)
    return ca.vertcat(y[0] * car.wheel_radius_m - speed_mps, y[0], y[2])


def wheel_rate(state: Any, torque_nm: Any, slip_reference: Any, car: Vehicle) -> Any:
    """Time derivative of [s, omega, e_int]: Eq. (e_int) goes with the wheel's dynamics."""
    s_rate, omega_rate = slip_dynamics(state[0], state[1], torque_nm, car, ca)
    error = slip_reference - slip_ratio(state[0], state[1], car)
    return ca.vertcat(s_rate, omega_rate, error)
