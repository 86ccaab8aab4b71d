"""The paper's single-wheel dynamics, written once for floats, arrays and CasADi symbols.

``s`` is the slip speed omega R - v in m/s and ``omega`` the wheel speed in
rad/s.  The sine and arctangent come from the ``functions`` argument, so that
the estimator (``math``), the data set (``numpy``) and the nonlinear MPC
(``casadi``) share these equations instead of copying them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from tcs_hil.model.vehicle import Vehicle

FloatArray = NDArray[np.float64]

DEFAULT_SUBSTEPS = 4
"""Runge-Kutta steps per 2 ms that keep mu = 0.3 stable down to standstill.

The modified slip bounds the fastest pole at 4000 1/s (at omega R = 0.32 m/s);
RK4 is stable up to 2.78 times the step, which one step of 2 ms passes at once.
"""


class Functions(Protocol):
    """What the tyre needs from ``math``, ``numpy`` or ``casadi``."""

    @property
    def sin(self) -> Callable[[Any], Any]:
        """Sine of an angle in rad."""
        ...

    @property
    def atan(self) -> Callable[[Any], Any]:
        """Arctangent, in rad."""
        ...


def slip_ratio(s: Any, omega: Any, vehicle: Vehicle) -> Any:
    """Modified slip ratio kappa of Eq. (slip_mod); finite at standstill."""
    rim_speed = omega * vehicle.wheel_radius_m
    return s * rim_speed / (rim_speed * rim_speed + vehicle.slip_epsilon_m2ps2)


def tyre_force_n(kappa: Any, vehicle: Vehicle, functions: Functions = np) -> Any:
    """Longitudinal tyre force in N by the simplified Magic Formula, Eq. (tire_model)."""
    peak_n = vehicle.friction_ratio * vehicle.wheel_load_n * vehicle.tyre_d
    return peak_n * functions.sin(vehicle.tyre_c * functions.atan(vehicle.tyre_b * kappa))


def slip_dynamics(
    s: Any, omega: Any, torque_nm: Any, vehicle: Vehicle, functions: Functions = np
) -> tuple[Any, Any]:
    """Time derivatives of s (m/s²) and omega (rad/s²) under one motor's torque.

    The paper prints -1/m in the equation of s; one wheel moves a quarter of the
    mass, hence -4/m, as in the paper's own equation of the vehicle speed.
    """
    force_n = tyre_force_n(slip_ratio(s, omega, vehicle), vehicle, functions)
    wheel_torque_nm = vehicle.gear_ratio * torque_nm
    radius_m = vehicle.wheel_radius_m
    omega_rate = (wheel_torque_nm - force_n * radius_m) / vehicle.wheel_inertia_kgm2
    return radius_m * omega_rate - 4.0 / vehicle.mass_kg * force_n, omega_rate


def rk4(
    rate: Callable[[Any], Any], x: Any, period_s: float, substeps: int = DEFAULT_SUBSTEPS
) -> Any:
    """Advance x' = rate(x) over one period by classic Runge-Kutta; any x that adds and scales."""
    step_s = period_s / substeps
    for _ in range(substeps):
        k1 = rate(x)
        k2 = rate(x + step_s / 2.0 * k1)
        k3 = rate(x + step_s / 2.0 * k2)
        k4 = rate(x + step_s * k3)
        x = x + step_s / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    return x


def rk4_step(
    x: FloatArray,
    torque_nm: FloatArray | float,
    vehicle: Vehicle,
    period_s: float,
    substeps: int = DEFAULT_SUBSTEPS,
) -> FloatArray:
    """State [s, omega] (2,) or (n, 2) one period later, the torque () or (n,) being held."""

    def rate(state: FloatArray) -> FloatArray:
        return np.stack(slip_dynamics(state[..., 0], state[..., 1], torque_nm, vehicle), axis=-1)

    next_x: FloatArray = rk4(rate, x, period_s, substeps)
    return next_x
