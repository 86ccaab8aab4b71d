"""Wheel dynamics against SciPy, hand calculation and CasADi."""

from __future__ import annotations

import math

import casadi
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tcs_hil.model.tyre import Tyre, slip_ratio, tyre_force_n
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.model.wheel import (
    fastest_pole_per_s,
    rk4,
    rk4_step,
    slip_dynamics,
    stable_substeps,
)

VEHICLE = Vehicle()
PERIOD_S = 0.002


def written_out(_: float, x: np.ndarray, torque_nm: float) -> list[float]:
    """The paper's equations with its numbers, in vehicle speed and wheel speed."""
    v, omega = x
    kappa = (omega * 0.318 - v) * omega * 0.318 / ((omega * 0.318) ** 2 + 0.1)
    force = 0.3 * 1400 * 9.81 / 4 * 1.2005 * math.sin(1.401 * math.atan(17.1571 * kappa))
    return [4 / 1400 * force, (3 * torque_nm - force * 0.318) / 1.22]


def reference_step(s: float, omega: float, torque_nm: float) -> np.ndarray:
    start = [omega * 0.318 - s, omega]
    options = {"method": "Radau", "rtol": 1e-11, "atol": 1e-12}
    v, omega = solve_ivp(written_out, (0, PERIOD_S), start, args=(torque_nm,), **options).y[:, -1]
    return np.array([omega * 0.318 - v, omega])


def test_the_modified_slip_is_zero_at_standstill_and_the_plain_one_at_speed():
    assert slip_ratio(0.0, 0.0, VEHICLE) == 0.0
    plain = 2.0 / (100.0 * 0.318)
    # epsilon / (omega R)² = 1e-4 is all that separates the two at 115 km/h
    assert slip_ratio(2.0, 100.0, VEHICLE) == pytest.approx(plain, rel=1.1e-4)


def test_the_tyre_peaks_at_slip_0121_with_its_full_friction():
    kappa = np.linspace(0.0, 1.0, 10_001)
    force = tyre_force_n(kappa, VEHICLE)
    assert kappa[force.argmax()] == pytest.approx(0.1209, abs=2e-4)
    assert force.max() == pytest.approx(0.3 * 3433.5 * 1.2005, rel=1e-6)
    assert tyre_force_n(0.1, VEHICLE) / force.max() == pytest.approx(0.994, abs=5e-4)


def test_the_tyres_secant_falls_with_slip_as_its_curve_does():
    kappa = np.linspace(1e-3, 0.5, 500)
    slope_n = tyre_force_n(1e-6, VEHICLE) / 1e-6
    secant = tyre_force_n(kappa, VEHICLE) / (slope_n * kappa)
    np.testing.assert_allclose(Tyre(VEHICLE).secant_ratio(kappa), secant, rtol=0.0, atol=0.04)


@pytest.mark.parametrize(
    ("s", "omega", "torque_nm", "tolerance_mps"),
    [
        (0.05, 80.0, 120.0, 1e-8),
        (0.5, 20.0, 175.0, 1e-8),
        (1.0, 6.0, 50.0, 1e-8),  # on the falling side of the tyre at 3 km/h
        (0.1, 1.0, 100.0, 1e-5),  # where the dynamics are fastest: 4000 1/s
        (0.0, 0.0, 100.0, 1e-4),
    ],
)
def test_one_period_agrees_with_an_implicit_integrator(s, omega, torque_nm, tolerance_mps):
    step = rk4_step(np.array([s, omega]), torque_nm, VEHICLE, PERIOD_S)
    error = np.abs(step - reference_step(s, omega, torque_nm)) * [1.0, 0.318]
    assert error.max() < tolerance_mps


def test_refining_the_step_converges_with_order_four():
    def error(substeps: int) -> float:
        step = rk4_step(np.array([0.5, 20.0]), 175.0, VEHICLE, PERIOD_S, substeps)
        return float(np.abs(step - reference_step(0.5, 20.0, 175.0)).max())

    # Twice the steps, a sixteenth of the error, give or take the next order's share.
    assert 12.0 < error(4) / error(8) < 20.0


def test_four_substeps_do_not_chatter_at_low_speed_where_one_does():
    def chatter_mps(substeps: int) -> float:
        omega = np.linspace(0.0, 6.0, 61)
        x = np.stack((np.full_like(omega, 0.01), omega), axis=-1)
        for _ in range(50):
            before, x = x, rk4_step(x, 50.0, VEHICLE, PERIOD_S, substeps)
        return float(np.abs(x - before)[:, 0].max())

    # The wheel has settled after 0.1 s: what still moves s is the integrator.
    assert chatter_mps(4) < 1e-3
    assert chatter_mps(1) > 2e-2


def test_a_grippier_road_gets_the_finer_steps_it_needs():
    asphalt = Vehicle(friction_ratio=1.0)
    assert stable_substeps(VEHICLE, PERIOD_S) == 4
    assert stable_substeps(asphalt, PERIOD_S) == 11
    assert stable_substeps(asphalt, PERIOD_S / 100) == 4


def test_the_fastest_pole_is_that_of_the_linearised_dynamics():
    rim = np.linspace(0.01, 10.0, 2000)
    delta = 1e-6
    # s deviates at a given vehicle speed, so omega deviates with it.
    ahead, behind = (
        slip_dynamics(d, (rim + d) / VEHICLE.wheel_radius_m, 0.0, VEHICLE)[0]
        for d in (delta, -delta)
    )
    pole = (ahead - behind) / (2 * delta)
    assert fastest_pole_per_s(VEHICLE) == pytest.approx(-pole.min(), rel=1e-3)


def test_many_wheels_move_as_each_would_alone():
    x = np.array([[0.5, 20.0], [0.1, 3.0], [0.0, 0.0]])
    torque = np.array([60.0, 100.0, 170.0])
    together = rk4_step(x, torque, VEHICLE, PERIOD_S)
    alone = [rk4_step(x[i], torque[i], VEHICLE, PERIOD_S) for i in range(3)]
    np.testing.assert_allclose(together, alone, rtol=1e-14)


def test_plain_floats_and_casadi_symbols_use_the_same_equations():
    floats = slip_dynamics(0.5, 20.0, 100.0, VEHICLE, math)
    x = casadi.SX.sym("x", 2)

    def rate(state: casadi.SX) -> casadi.SX:
        return casadi.vertcat(*slip_dynamics(state[0], state[1], 100.0, VEHICLE, casadi))

    step = casadi.Function("step", [x], [rate(x), rk4(rate, x, PERIOD_S)])
    symbolic_rate, symbolic_step = step([0.5, 20.0])
    numeric_step = rk4_step(np.array([0.5, 20.0]), 100.0, VEHICLE, PERIOD_S)
    np.testing.assert_allclose(symbolic_rate.full().ravel(), floats, rtol=1e-13)
    np.testing.assert_allclose(symbolic_step.full().ravel(), numeric_step, rtol=1e-13)
