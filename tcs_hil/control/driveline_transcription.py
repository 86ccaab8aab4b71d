"""The default nonlinear MPC as a least-squares problem: driveline, tyre lag and Δu in it.

State x = [s, omega, e_int, T_motor, omega_motor, twist, F_x]; omega_motor is on
the wheel side of the gear.  With i the gear ratio, K and D of the half-shaft:

    s'           = R omega' - 2/m F_x - a_d    (two driven wheels move the car)
    omega'       = (K twist + D (omega_motor - omega) - F_x R) / J_wheel
    e_int'       = kappa_ref - kappa
    T_motor'     = (u - T_motor) / lag
    omega_motor' = (i T_motor - K twist - D (omega_motor - omega)) / J_motor
    twist'       = omega_motor - omega
    F_x'         = (F(kappa) + dF - F_x) / (relaxation(kappa) / v_roll + 2.5 ms)

v_roll is the rim's speed, and 1.5 m/s more by their squares (`CREEP_MPS`).
F(kappa) is the paper's tyre, dF the disturbance the observer holds it to, a_d what the
body gains besides.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import casadi as ca

from tcs_hil.control.driveline import CREEP_MPS
from tcs_hil.control.least_squares import gauss_newton
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.tyre import Tyre, slip_ratio
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.model.wheel import rk4

NX = 7

FASTEST_TYRE_S = 0.0025
"""No tyre is believed to be faster: one Runge-Kutta step of 4 ms must stay stable at any speed."""


@lru_cache(maxsize=8)
def plan_function(settings: ControlSettings, vehicle: Vehicle) -> Any:
    """CasADi function (x_0 (7,), U (N,), p (5,)) -> cost, gradient, Hessian."""
    tuning = settings.default.nmpc
    x0, plan = ca.SX.sym("x0", NX), ca.SX.sym("U", len(tuning.blocks))
    parameters = ca.SX.sym("p", 5)
    torque_ref, last, *disturbance, urgency = ca.vertsplit(parameters)
    x, residuals = x0, []
    slip_gain, integral_gain, reduction_gain = (
        math.sqrt(weight / tuning.weight_change)
        for weight in (tuning.weight_slip, tuning.weight_integral, tuning.weight_reduction)
    )
    for torque, periods in zip(ca.vertsplit(plan), tuning.blocks, strict=True):
        duration_s = periods * settings.period_s
        x = advance(x, torque, duration_s, disturbance, settings, vehicle)
        error = settings.slip_reference - slip_ratio(x[0], x[1], vehicle)
        held = math.sqrt(periods)
        tracking = held * urgency
        residuals += [tracking * slip_gain * error, tracking * integral_gain * x[2]]
        residuals += [held * reduction_gain * (torque_ref - torque), torque - last]
        last = torque
    return gauss_newton("driveline", x0, plan, parameters, ca.vertcat(*residuals))


@lru_cache(maxsize=8)
def advance_function(settings: ControlSettings, vehicle: Vehicle) -> Any:
    """CasADi function (x (7,), [u, duration in s, dF, a_d]) -> x after the duration."""
    x, parameters = ca.SX.sym("x", NX), ca.SX.sym("p", 4)
    torque, duration, *disturbance = ca.vertsplit(parameters)
    after = advance(x, torque, duration, disturbance, settings, vehicle)
    return ca.Function("advance", [x, parameters], [after], {"cse": True})


def advance(
    x: Any,
    torque_nm: Any,
    duration_s: Any,
    disturbance: Sequence[Any],
    settings: ControlSettings,
    car: Vehicle,
) -> Any:
    """State (7,) after at most 4 ms of a commanded motor torque."""

    def rate(state: Any) -> Any:
        return driveline_rate(state, torque_nm, disturbance, settings, car)

    return rk4(rate, x, duration_s, substeps=1)


def driveline_rate(
    x: Any, torque_nm: Any, disturbance: Sequence[Any], settings: ControlSettings, car: Vehicle
) -> Any:
    """Time derivative of the state (7,) under a disturbance (dF in N, a_d in m/s²)."""
    disturbance_n, disturbance_mps2 = disturbance
    line, radius_m = settings.default.driveline, car.wheel_radius_m
    s, omega, _, motor_nm, motor_omega, twist, force_n = ca.vertsplit(x)
    kappa = slip_ratio(s, omega, car)
    twist_rate = motor_omega - omega
    shaft_nm = line.shaft_stiffness_nmprad * twist + line.shaft_damping_nmsprad * twist_rate
    omega_rate = (shaft_nm - force_n * radius_m) / line.wheel_inertia_kgm2
    rolling_mps = ca.sqrt((omega * radius_m) ** 2 + CREEP_MPS**2)
    tyre, sliding_m = Tyre(car, ca), line.tyre_sliding_m
    relaxation_m = sliding_m + (line.tyre_relaxation_m - sliding_m) * tyre.secant_ratio(kappa)
    settling = 1.0 / (relaxation_m / rolling_mps + FASTEST_TYRE_S)
    return ca.vertcat(
        radius_m * omega_rate - 2.0 / car.mass_kg * force_n - disturbance_mps2,
        omega_rate,
        settings.slip_reference - kappa,
        (torque_nm - motor_nm) / line.motor_lag_s,
        (car.gear_ratio * motor_nm - shaft_nm) / line.motor_inertia_kgm2,
        twist_rate,
        (tyre.force_n(kappa) + disturbance_n - force_n) * settling,
    )
