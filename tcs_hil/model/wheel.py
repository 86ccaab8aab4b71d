"""The paper's single-wheel dynamics, written once for floats, arrays and CasADi symbols.

``s`` is the slip speed omega R - v in m/s and ``omega`` the wheel speed in rad/s; slip and
tyre are those of ``tyre.py``.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tcs_hil.model.tyre import Functions, slip_ratio, tyre_force_n
from tcs_hil.model.vehicle import Vehicle

FloatArray = NDArray[np.float64]

DEFAULT_SUBSTEPS = 4
"""Runge-Kutta steps that carry the paper's car and road through 2 ms at every speed."""

_STABLE_STEP = 2.5
"""Step times pole that RK4 still damps, with a margin to its limit of 2.785."""


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


def fastest_pole_per_s(vehicle: Vehicle) -> float:
    """Largest rate of decay of s over all speeds, in 1/s; 4000 on the paper's road.

    The modified slip rises fastest at free rolling and omega R = sqrt(epsilon),
    by 1 / (2 sqrt(epsilon)) per m/s of slip speed.
    """
    peak_n = vehicle.friction_ratio * vehicle.wheel_load_n * vehicle.tyre_d
    slope_n = peak_n * vehicle.tyre_c * vehicle.tyre_b
    inverse_mass = vehicle.wheel_radius_m**2 / vehicle.wheel_inertia_kgm2 + 4.0 / vehicle.mass_kg
    return float(slope_n * inverse_mass / (2.0 * math.sqrt(vehicle.slip_epsilon_m2ps2)))


def stable_substeps(vehicle: Vehicle, period_s: float) -> int:
    """Runge-Kutta steps per period that are stable at every speed, at least the default."""
    needed = math.ceil(period_s * fastest_pole_per_s(vehicle) / _STABLE_STEP)
    return max(DEFAULT_SUBSTEPS, needed)


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
