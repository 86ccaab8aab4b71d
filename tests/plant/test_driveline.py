"""Motor, gear and half-shaft against hand calculation."""

import math

import numpy as np
import pytest

from plant_emulator.compiled import records
from plant_emulator.driveline import Driveline, attainable, shaft_torque, torque_rate

# Wheels that no road holds back: what is left is wheel, shaft and motor.
LOOSE = {"road": [{"mu": 1e-9}], "tyre": {"qsy1": 0.0}}


def test_the_motor_follows_with_its_lag():
    line = records(Driveline(motor_torque_rate_nmps=1e9))[0]
    assert torque_rate(line, 100.0, 0.0) == pytest.approx(100.0 / 0.005)


def test_the_motor_follows_no_faster_than_its_rate():
    assert torque_rate(records(Driveline())[0], 250.0, 0.0) == 8000.0
    assert torque_rate(records(Driveline())[0], 0.0, 250.0) == -8000.0


def test_a_lag_of_5_ms_is_63_percent_after_5_ms(drive):
    plant = drive(
        [[0.0, 100.0]], driveline={"motor_torque_rate_nmps": 1e9}, start_speed_kmph=50.0, **LOOSE
    )
    plant.step(None, 0.005)
    assert plant.truth.motor_torque_nm[0] == pytest.approx(100.0 * (1 - math.exp(-1)), rel=1e-6)


@pytest.mark.parametrize(
    ("speed_radps", "asked_nm", "given_nm"),
    [
        (0.0, 400.0, 250.0),
        (400.0, 250.0, 80_000.0 / 400.0),
        (1600.0, 250.0, 0.0),
        (100.0, -400.0, -250.0),
        (100.0, 30.0, 30.0),
    ],
)
def test_torque_power_and_speed_are_limited(speed_radps, asked_nm, given_nm):
    assert attainable(records(Driveline())[0], asked_nm, speed_radps) == pytest.approx(given_nm)


def test_lash_transmits_nothing_and_teeth_never_pull():
    line = records(Driveline(shaft_lash_rad=0.02))[0]
    assert shaft_torque(line, 0.005, 10.0) == 0.0
    assert shaft_torque(line, 0.011, 0.0) == pytest.approx(6.0)
    assert shaft_torque(line, 0.011, -10.0) == 0.0
    assert shaft_torque(line, -0.011, 10.0) == 0.0


def test_the_half_shaft_rings_at_sqrt_k_over_j(drive):
    plant = drive(
        [[0.0, 50.0]],
        driveline={"shaft_damping_nmsprad": 1.0, "motor_lag_s": 0.0, "motor_power_max_w": 1e9},
        start_speed_kmph=50.0,
        **LOOSE,
    )
    twists = []
    for _ in range(2000):
        plant.step(None, 0.0001)
        twists.append(plant.truth.shaft_twist_rad[0])
    wave = np.array(twists) - np.mean(twists)
    rising = np.flatnonzero((wave[:-1] < 0) & (wave[1:] >= 0))
    frequency_hz = 1.0 / (np.diff(rising).mean() * 1e-4)
    inertia = 1.0 / (1.0 / 0.95 + 1.0 / (9 * 0.03))
    assert frequency_hz == pytest.approx(math.sqrt(6000.0 / inertia) / (2 * math.pi), rel=0.01)


@pytest.mark.parametrize("stiffness_nmprad", [0.0, 6000.0])
def test_motor_and_wheel_together_have_the_papers_inertia(drive, stiffness_nmprad):
    plant = drive(
        [[0.0, 50.0]],
        driveline={"shaft_stiffness_nmprad": stiffness_nmprad, "motor_lag_s": 0.0},
        start_speed_kmph=36.0,
        **LOOSE,
    )
    before = plant.truth.wheel_speed_radps[0]
    plant.step(None, 0.2)
    gained = plant.truth.wheel_speed_radps[0] - before
    assert gained == pytest.approx(3.0 * 50.0 / 1.22 * 0.2, rel=0.01)


def test_a_rigid_shaft_never_twists(drive):
    plant = drive([[0.0, 100.0]], driveline={"shaft_stiffness_nmprad": 0.0})
    plant.step(None, 0.5)
    truth = plant.truth
    assert truth.shaft_twist_rad == pytest.approx((0.0, 0.0), abs=1e-12)
    assert truth.motor_speed_radps[0] == pytest.approx(3.0 * truth.wheel_speed_radps[0])
