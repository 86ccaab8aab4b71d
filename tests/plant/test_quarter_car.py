"""The quarter car against the paper's equations, integrated by someone else."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from plant_emulator.plant import Plant
from plant_emulator.scenario import load_scenario
from tcs_hil.signals import TorqueLimits

M, G, R, J, GEAR, EPSILON = 1400.0, 9.81, 0.318, 1.22, 3.0, 0.1
D, C, B = 1.2005, 1.4010, 17.1571
MU = 0.3
START = (2 / 3.6, 2 / 3.6 / R)


def paper(t, x, cap_nm):
    """Eqs. (vw_nl_model), (tire_model) and (slip_mod), written out anew."""
    v, omega = x
    rim = omega * R
    kappa = (rim - v) * rim / (rim**2 + EPSILON)
    force = MU * M * G / 4 * D * math.sin(C * math.atan(B * kappa))
    torque = min(float(np.interp(t, [0.1, 0.6], [0.0, 250.0])), cap_nm)
    return [4 / M * force, (GEAR * torque - force * R) / J]


def reference(cap_nm, end_s):
    """Integrate piece by piece: a step of the reference must not straddle a corner."""
    state, start = START, 0.0
    for corner in (0.1, 0.1 + 0.5 * cap_nm / 250.0, end_s):
        piece = solve_ivp(
            paper, (start, corner), state, "DOP853", rtol=1e-13, atol=1e-13, args=(cap_nm,)
        )
        state, start = piece.y[:, -1], corner
    return state


def driven(limits, end_s):
    plant = Plant(load_scenario("manoeuvre-1"))
    while plant.time_s < end_s - 1e-6:
        plant.step(limits, 0.002)
    return plant.truth


@pytest.mark.parametrize("cap_nm", [100.0, 120.0, 250.0])
def test_it_solves_the_papers_equations_to_1e_9(cap_nm):
    truth = driven(TorqueLimits(cap_nm, cap_nm), 1.5)
    speed, omega = reference(cap_nm, 1.5)
    assert truth.speed_mps == pytest.approx(speed, abs=1e-9)
    assert truth.wheel_speed_radps[:2] == pytest.approx((omega, omega), abs=1e-9)


def test_without_control_the_wheels_spin_up():
    truth = driven(None, 3.0)
    assert min(truth.slip_ratio[:2]) > 0.9


def test_each_wheel_has_its_own_limit_and_the_car_one_speed():
    truth = driven(TorqueLimits(100.0, 50.0), 2.0)
    left, right, rear_left, rear_right = truth.wheel_speed_radps
    assert truth.motor_torque_nm == (100.0, 50.0)
    assert left > right > rear_left == rear_right == pytest.approx(truth.speed_mps / R)


def test_the_end_of_the_road_ends_the_scenario():
    plant = Plant(load_scenario("manoeuvre-2"))
    while not plant.finished:
        plant.step(None, 0.002)
    assert plant.truth.distance_m == pytest.approx(50.0, abs=0.05)
    assert plant.time_s < 8.0


def test_friction_changes_where_the_road_says():
    plant = Plant(load_scenario("manoeuvre-2"))
    seen = {}
    while not plant.finished:
        truth = plant.truth
        seen.setdefault(truth.mu[0], truth.distance_m)
        plant.step(None, 0.002)
    assert seen == {0.3: 0.0, 0.15: pytest.approx(10, abs=0.05), 0.6: pytest.approx(20, abs=0.05)}
