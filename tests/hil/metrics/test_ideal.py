"""Ideal speed against hand calculation."""

import math

import msgspec
import pytest

from plant_emulator.scenario import Scenario, load_scenario
from tcs_hil.hil.metrics import ideal_speed_gained_mps

GRAVITY = 9.81
RADIUS_M, MASS_KG, SPIN_KG = 0.318, 1400.0, 2 * 0.95 / 0.318**2
FULL = {"request": [[0.0, 250.0]]}


def scenario(variant: str, road: list[dict[str, float]], **rest: object) -> Scenario:
    table = {"description": "", "driver": FULL, "duration_s": 3.0, "road": road, **rest}
    vehicle = {
        "variant": variant,
        "body": {"drag_area_m2": 0.0},
        "tyre": {"qsy1": 0.0, "pdx2": 0.0},
    }
    return msgspec.convert({"vehicle": vehicle, **table}, Scenario)


def test_a_quarter_car_gains_mu_d_g_per_second() -> None:
    gained = ideal_speed_gained_mps(scenario("quarter-car", [{"mu": 0.3}]), 2.0)
    assert gained == pytest.approx(0.3 * 1.2005 * GRAVITY * 2.0)


def test_a_front_driven_car_loses_what_its_front_axle_sheds() -> None:
    gained = ideal_speed_gained_mps(scenario("vehicle", [{"mu": 0.3}]), 2.0)
    mu, front, height = 0.3 * 1.2005, 1.33 / 2.62, 0.526 / 2.62
    accel = mu * MASS_KG * GRAVITY * front / (MASS_KG * (1.0 + mu * height) + SPIN_KG)
    assert gained == pytest.approx(2.0 * accel, rel=1e-3)


def test_on_dry_road_the_drivers_torque_is_the_limit() -> None:
    gained = ideal_speed_gained_mps(scenario("vehicle", [{"mu": 1.0}]), 1.0)
    inertias_kg = (2 * 1.22 + 2 * 0.95) / RADIUS_M**2
    accel = 2 * 3 * 250.0 / RADIUS_M / (MASS_KG + inertias_kg)
    assert gained == pytest.approx(accel, rel=1e-3)


def test_at_speed_the_motors_power_is_the_limit() -> None:
    fast = scenario("vehicle", [{"mu": 1.0}], start_speed_kmph=144.0)
    inertias_kg = (2 * 1.22 + 2 * 0.95) / RADIUS_M**2
    accel = 2 * 80e3 / 40.0 / (MASS_KG + inertias_kg)
    # The power falls with speed: over 0.1 s by less than one percent.
    assert ideal_speed_gained_mps(fast, 0.1) == pytest.approx(0.1 * accel, rel=0.01)


def test_friction_is_that_of_the_place_the_ideal_car_has_reached() -> None:
    road = [{"mu": 0.3}, {"from_m": 10.0, "mu": 0.15}]
    accel = 1.2005 * GRAVITY * 0.3
    reached_s = math.sqrt(2.0 * 10.0 / accel)
    gained = ideal_speed_gained_mps(scenario("quarter-car", road), 4.0)
    assert gained == pytest.approx(accel * (reached_s + 0.5 * (4.0 - reached_s)), rel=2e-3)


def test_on_split_friction_each_side_gives_its_own() -> None:
    split = scenario("quarter-car", [{"mu_left": 0.1, "mu_right": 0.3}])
    even = scenario("quarter-car", [{"mu": 0.2}])
    assert ideal_speed_gained_mps(split, 2.0) == pytest.approx(ideal_speed_gained_mps(even, 2.0))


def test_a_hill_takes_g_sin_theta_and_load_off_the_front_axle() -> None:
    hill = scenario("vehicle", [{"mu": 0.3, "grade": 0.1}])
    sine, cosine = 0.1 / math.hypot(1.0, 0.1), 1.0 / math.hypot(1.0, 0.1)
    mu, front, height = 0.3 * 1.2005, 1.33 / 2.62, 0.526 / 2.62
    push = MASS_KG * GRAVITY * (mu * (front * cosine - height * sine) - sine)
    accel = push / (MASS_KG * (1.0 + mu * height) + SPIN_KG)
    assert ideal_speed_gained_mps(hill, 2.0) == pytest.approx(2.0 * accel, rel=1e-3)


def test_a_car_that_cannot_climb_stands() -> None:
    ice = scenario("vehicle", [{"mu": 0.08, "grade": 0.2}])
    assert ideal_speed_gained_mps(ice, 2.0) == 0.0


def test_the_ramp_of_the_paper_costs_what_it_holds_back() -> None:
    ramp = load_scenario("manoeuvre-1").with_variant("quarter-car")
    at_once = msgspec.structs.replace(ramp, driver=scenario("vehicle", [{"mu": 1.0}]).driver)
    lost_mps = ideal_speed_gained_mps(at_once, 3.0) - ideal_speed_gained_mps(ramp, 3.0)
    # Nothing for 0.1 s, then in proportion until the peak force needs no more torque.
    force_n, accel = 1030.05 * 1.2005, 0.3 * 1.2005 * GRAVITY
    full_s = (force_n * RADIUS_M + 1.22 * accel / RADIUS_M) / 3.0 / 500.0
    assert lost_mps == pytest.approx(accel * (0.1 + 0.5 * full_s), rel=0.01)
