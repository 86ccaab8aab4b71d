"""The whole car against mechanics: forces, loads, energy, standstill, convergence."""

import math

import numpy as np
import pytest
from plant.rows import rows

from plant_emulator import runge_kutta
from tcs_hil.errors import ConfigError
from tcs_hil.signals import TorqueLimits

M, G, R, L, H = 1400.0, 9.81, 0.318, 2.62, 0.526
WHEEL_J, MOTOR_J, GEAR = 0.95, 0.03, 3.0


def test_steady_acceleration_is_what_hand_calculation_says(drive):
    """100 Nm a motor on a dry road: torque over all that moves, less resistance."""
    truth = rows(drive([[0.0, 100.0]]), 2.5)[-1]
    spinning = (4 * WHEEL_J + 2 * GEAR**2 * MOTOR_J) / R**2
    rolling_n = 0.01 * M * G
    drag_n = 0.5 * 1.2 * 0.65 * truth["speed_mps"] ** 2
    by_hand = (2 * GEAR * 100.0 / R - rolling_n - drag_n) / (M + spinning)
    assert truth["accel_mps2"] == pytest.approx(by_hand, rel=0.005)


def test_load_transfer_is_m_a_h_over_l(drive):
    """The wheels' spin-up adds its own reaction, J domega/dt over the wheelbase."""
    plant = drive([[0.0, 150.0]], tyre={"qsy1": 0.0}, body={"drag_area_m2": 0.0})
    still = plant.truth.load_n
    truth = rows(plant, 4.0)[-1]
    accel = truth["accel_mps2"]
    by_hand = (M * accel * H + 4 * WHEEL_J * accel / R) / L
    assert 2 * (still[0] - truth["load_n"][0]) == pytest.approx(by_hand, rel=0.002)
    assert truth["load_n"].sum() == pytest.approx(M * G, rel=1e-4)


def test_static_loads_follow_the_centre_of_gravity(drive):
    front, _, rear, _ = drive().truth.load_n
    assert (2 * front, 2 * rear) == pytest.approx((M * G * 1.33 / L, M * G * 1.29 / L), rel=1e-6)


def test_without_load_transfer_the_loads_stay(drive):
    recorded = rows(drive([[0.0, 200.0]], body={"load_transfer": False}), 1.0)
    assert np.ptp(recorded["load_n"], axis=0) == pytest.approx(0.0, abs=1e-9)
    assert not recorded["pitch_rad"].any()


def test_the_body_pitches_at_its_natural_frequency(drive):
    """Half-car: heave and pitch of 1210 kg and 1900 kg m2 on 40 and 42 kN/m, by eigenvalues."""
    body = {"front_damping_nspm": 200.0, "rear_damping_nspm": 200.0}
    recorded = rows(
        drive([[0.0, 0.0], [0.1, 100.0], [0.2, 0.0]], body=body, start_speed_kmph=60.0), 8.0
    )
    wave = recorded["pitch_rad"][200:]
    spectrum = np.abs(np.fft.rfft((wave - wave.mean()) * np.hanning(wave.size), 2**17))
    measured_hz = np.fft.rfftfreq(2**17, 0.002)[spectrum.argmax()]
    front_m = (M * 1.29 - 95.0 * L) / 1210.0
    rear_m = L - front_m
    stiffness = np.array(
        [[82e3, 40e3 * front_m - 42e3 * rear_m], [0.0, 40e3 * front_m**2 + 42e3 * rear_m**2]]
    )
    stiffness[1, 0] = stiffness[0, 1]
    modes_hz = np.sqrt(np.linalg.eigvals(np.diag([1 / 1210.0, 1 / 1900.0]) @ stiffness)) / (
        2 * np.pi
    )
    assert np.abs(modes_hz - measured_hz).min() < 0.05


def test_the_record_holds_every_state(drive):
    """Angles and twists are the integrals of recorded speeds; the hold says that it holds."""
    recorded = rows(drive([[0.2, 0.0], [0.3, 100.0]], road=[{"mu": 1.0, "grade": 0.1}]), 1.0)
    assert set(recorded["held"].tolist()) == {0.0, 1.0}
    closed = recorded["held"] > 0.0
    assert np.abs(recorded["hold_twist_rad"][closed]).max() > 1e-3
    assert not recorded["hold_twist_rad"][~closed].any()
    for rate, integral in (
        ("heave_rate_mps", "heave_m"),
        ("pitch_rate_radps", "pitch_rad"),
        ("wheel_speed_radps", "wheel_angle_rad"),
    ):
        gained = recorded[integral][-1] - recorded[integral][0]
        area = np.trapezoid(recorded[rate], recorded["time_s"], axis=0)
        assert gained == pytest.approx(area, rel=1e-3, abs=1e-5)
    fast = recorded["speed_mps"] > 1.0
    assert recorded["transient_slip_ratio"][fast] == pytest.approx(
        recorded["tyre_slip_ratio"][fast]
    )


def test_a_held_car_stands_still_on_a_slope(drive):
    recorded = rows(drive(road=[{"mu": 1.0, "grade": 0.2}]), 2.0)
    assert np.abs(recorded["speed_mps"]).max() < 1e-3
    assert np.ptp(recorded["distance_m"]) < 1e-4
    assert recorded["force_n"][-1].sum() == pytest.approx(
        M * G * math.sin(math.atan(0.2)), rel=1e-3
    )


def test_a_rolling_car_comes_to_rest_without_chatter(drive):
    recorded = rows(drive(road=[{"mu": 1.0, "grade": 0.05}], start_speed_kmph=3.0), 4.0)
    rest = recorded[recorded["time_s"] > 3.0]
    assert np.abs(rest["speed_mps"]).max() < 1e-3
    assert np.abs(rest["force_n"] - rest["force_n"].mean(axis=0)).max() < 5.0


def test_without_a_brake_the_car_rolls_back_down_and_stays_finite(drive):
    plant = drive([[0.0, 1.0]], road=[{"mu": 0.3, "grade": 0.15}])
    recorded = rows(plant, 2.0)
    assert recorded["speed_mps"][-1] == pytest.approx(
        0.0, abs=1e-3
    )  # 1 Nm does not open the brakes
    plant = drive([[0.0, 160.0], [0.3, 60.0]], road=[{"mu": 0.3, "grade": 0.15}])
    recorded = rows(plant, 2.0)
    assert recorded["speed_mps"][-1] < -0.3
    assert np.abs(np.diff(recorded["accel_mps2"][-200:])).max() < 0.05


def test_the_brakes_open_when_the_throttle_carries_the_car(drive):
    recorded = rows(drive([[0.5, 0.0], [1.5, 250.0]], road=[{"mu": 1.0, "grade": 0.2}]), 3.0)
    assert recorded["speed_mps"].min() > -0.02
    assert recorded["speed_mps"][-1] > 1.0


def test_a_limit_of_zero_does_not_let_a_held_car_roll_away(drive):
    plant = drive([[0.0, 250.0]], road=[{"mu": 1.0, "grade": 0.2}])
    for _ in range(500):
        plant.step(TorqueLimits(0.0, 0.0), 0.002)
    assert abs(plant.truth.distance_m) < 1e-3


def test_a_car_that_a_limit_of_zero_stops_on_a_hill_stays_there(drive):
    plant = drive([[0.0, 250.0]], road=[{"mu": 1.0, "grade": 0.2}])
    plant.step(None, 0.5)
    assert plant.truth.speed_mps > 0.2
    reached = []
    for _ in range(2000):
        plant.step(TorqueLimits(0.0, 0.0), 0.002)
        reached.append(plant.truth.distance_m)
    assert max(reached) - reached[-1] < 0.02
    assert abs(plant.truth.speed_mps) < 1e-3


def test_the_rear_wheels_reach_a_patch_a_wheelbase_later(drive):
    recorded = rows(
        drive(road=[{"mu": 1.0}, {"from_m": 5.0, "mu": 0.3}], start_speed_kmph=36.0), 1.0
    )
    front = recorded["distance_m"][np.argmax(recorded["mu"][:, 0] < 1.0)]
    rear = recorded["distance_m"][np.argmax(recorded["mu"][:, 2] < 1.0)]
    assert (front, rear) == pytest.approx((5.0, 5.0 + L), abs=0.03)


@pytest.mark.parametrize("variant", ["vehicle", "quarter-car"])
def test_a_step_ends_where_an_axle_comes_onto_another_patch(drive, variant):
    """Both axles cross within steps of 0.1 ms; cutting the time finer finds the same car.

    2 ms later: an error has no time to settle.
    """
    road = [{"mu": 1.0}, {"from_m": 0.50037, "mu": 0.3}, {"from_m": 0.50037 + L, "mu": 0.8}]

    def end_radps(step_s):
        plant = drive([[0.0, 200.0]], road=road, start_speed_kmph=72.0, variant=variant)
        for _ in range(round(0.158 / step_s)):
            plant.step(None, step_s)
        assert plant.truth.mu[0] == 0.8
        return plant.truth.wheel_speed_radps[0]

    assert end_radps(1e-4) == pytest.approx(end_radps(1e-5), abs=1e-6)


def test_a_car_that_rolls_back_meets_the_edges_it_has_passed(drive):
    road = [{"mu": 0.2, "grade": 0.2}, {"from_m": 0.2, "mu": 0.3, "grade": 0.2}]
    recorded = rows(drive([[0.0, 300.0], [0.5, 10.0]], road=road, start_speed_kmph=3.0), 3.0)
    assert {0.2, 0.3} == set(recorded["mu"][:, 0].tolist())
    assert recorded["distance_m"][-1] < 0.2
    assert recorded["mu"][-1, 0] == 0.2


def test_each_side_has_its_own_friction(drive):
    truth = rows(drive([[0.0, 250.0]], road=[{"mu_left": 0.1, "mu_right": 0.6}]), 1.0)[-1]
    assert truth["slip_ratio"][0] > 0.9
    assert truth["force_n"][1] > 3.0 * truth["force_n"][0]


def test_at_200_km_h_on_ice_nothing_breaks(drive):
    recorded = rows(
        drive([[0.2, 0.0], [0.2, 250.0]], road=[{"mu": 0.08}], start_speed_kmph=200.0), 3.0
    )
    assert all(
        np.isfinite(recorded[name]).all() for name in recorded.dtype.names if name != "limit_nm"
    )
    assert recorded["motor_speed_radps"].max() < 1500.0


def test_with_every_effect_off_two_torques_push_the_whole_mass(drive):
    """The quarter car gains 4 F / m; a front-driven car 2 F / m, less what spins its wheels."""
    plant = drive(
        [[0.0, 60.0]],
        body={"load_transfer": False, "drag_area_m2": 0.0},
        tyre={"relaxation_m": 0.0, "qsy1": 0.0},
        driveline={"motor_lag_s": 0.0, "shaft_stiffness_nmprad": 0.0},
        start_speed_kmph=20.0,
    )
    truth = rows(plant, 1.0)[-1]
    spinning = (4 * WHEEL_J + 2 * GEAR**2 * MOTOR_J) / R**2
    assert truth["accel_mps2"] == pytest.approx(2 * GEAR * 60.0 / R / (M + spinning), rel=1e-3)


@pytest.mark.parametrize("dt_s", [-0.002, math.nan, math.inf])
def test_time_that_cannot_pass_is_refused(drive, dt_s):
    with pytest.raises(ValueError, match="dt_s must be finite and not negative"):
        drive().step(None, dt_s)


def test_a_plant_too_stiff_to_integrate_says_so(drive):
    plant = drive([[0.0, 50.0]], body={"front_damping_nspm": 1e9}, start_speed_kmph=20.0)
    with pytest.raises(ConfigError, match=r"diverged at .* \[vehicle\]"):
        rows(plant, 1.0)


@pytest.fixture
def endpoint(drive, monkeypatch):
    """Speed of a driven wheel after 50 ms of a smooth push, integrated with one step size."""

    def run(step_s):
        plant = drive([[0.0, 80.0]], road=[{"mu": 0.6}], start_speed_kmph=36.0)
        for _ in range(round(0.05 / step_s)):
            plant.step(TorqueLimits(), step_s)
        return plant.truth.wheel_speed_radps[0]

    return run


def test_the_integration_converges_with_fourth_order(endpoint):
    """Steps below 0.1 ms are taken as they are; the error falls 16-fold with each halving."""
    best = endpoint(6.25e-6)
    errors = [abs(endpoint(step) - best) for step in (1e-4, 5e-5)]
    order = math.log2(errors[0] / errors[1])
    assert runge_kutta.MAX_STEP_S == 1e-4
    assert order > 3.5
    assert errors[0] < 1e-6
