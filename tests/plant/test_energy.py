"""Energy: what the motors put into the car is where it should be."""

import numpy as np
import pytest
from plant.rows import rows

M, R, L, H = 1400.0, 0.318, 2.62, 0.526
WHEEL_J, MOTOR_J, GEAR = 0.95, 0.03, 3.0


@pytest.mark.parametrize("throttle_nm", [100.0, 250.0])
@pytest.mark.parametrize("mu", [0.3, 1.0])
def test_the_energy_adds_up(drive, throttle_nm, mu):
    """Motor work = kinetic energy + what tyres, shafts, dampers, air and rolling take.

    Level road, no suspension (its energy is not in the truth), rigid shaft.
    """
    plant = drive(
        [[0.0, 0.0], [0.5, throttle_nm]],
        road=[{"mu": mu}],
        body={"load_transfer": False},
        driveline={"shaft_stiffness_nmprad": 0.0},
        start_speed_kmph=20.0,
    )
    t = rows(plant, 2.0, 0.0005)
    v, omega, motor = t["speed_mps"], t["wheel_speed_radps"], t["motor_speed_radps"]

    def kinetic(i):
        spin = 0.5 * WHEEL_J * (omega[i] ** 2).sum() + 0.5 * MOTOR_J * (motor[i] ** 2).sum()
        return 0.5 * M * v[i] ** 2 + spin

    motors = (t["motor_torque_nm"] * motor).sum(axis=1)
    slip = (t["force_n"] * (omega * R - v[:, None])).sum(axis=1)
    rim = omega * R
    rolling = (0.01 * t["load_n"] * rim / np.hypot(rim, 0.1) * rim).sum(axis=1)
    air = 0.5 * 1.2 * 0.65 * v**3
    net_j = np.trapezoid(motors - slip - rolling - air, t["time_s"])
    # Trapezoids of 0.5 ms over a run with kinks; the integrator itself is far better.
    assert kinetic(-1) - kinetic(0) == pytest.approx(net_j, rel=2e-4)


@pytest.mark.parametrize("mu", [0.3, 1.0])
def test_the_energy_of_the_default_car_adds_up(drive, mu):
    """As above with half-shafts, springs and dampers: what pitch and heave store and take.

    The suspension is linear: the moment that pitches the body takes nothing from its
    forward motion, so that its work comes in beside that of the motors.
    """
    plant = drive([[0.0, 0.0], [0.5, 200.0]], road=[{"mu": mu}], start_speed_kmph=20.0)
    t = rows(plant, 2.0, 0.0005)
    v, omega, motor = t["speed_mps"], t["wheel_speed_radps"], t["motor_speed_radps"]
    sprung_kg, rim = M - 190.0, omega * R
    front_m = (M * 1.29 - 95.0 * L) / sprung_kg
    above_hubs_m = (M * H - 190.0 * R) / sprung_kg - R
    arms = np.array([front_m, front_m - L])
    travel = t["heave_m"][:, None] + arms * t["pitch_rad"][:, None]
    travel_rate = t["heave_rate_mps"][:, None] + arms * t["pitch_rate_radps"][:, None]
    stored = (
        0.5 * M * v**2
        + 0.5 * WHEEL_J * (omega**2).sum(axis=1)
        + 0.5 * MOTOR_J * (motor**2).sum(axis=1)
        + 0.5 * 6000.0 * (t["shaft_twist_rad"] ** 2).sum(axis=1)
        + 0.5 * sprung_kg * t["heave_rate_mps"] ** 2
        + 0.5 * 1900.0 * t["pitch_rate_radps"] ** 2
        + 0.5 * (np.array([40e3, 42e3]) * travel**2).sum(axis=1)
    )
    air_n = 0.5 * 1.2 * 0.65 * v**2
    push_n = sprung_kg * t["accel_mps2"] + air_n
    moment = push_n * above_hubs_m + t["shaft_torque_nm"].sum(axis=1)
    into = (t["motor_torque_nm"] * motor).sum(axis=1) + moment * t["pitch_rate_radps"]
    lost = {
        "slip": (t["force_n"] * (rim - v[:, None])).sum(axis=1),
        "rolling": (0.01 * t["load_n"] * rim / np.hypot(rim, 0.1) * rim).sum(axis=1),
        "shafts": 25.0 * ((motor / GEAR - omega[:, :2]) ** 2).sum(axis=1),
        "dampers": 3500.0 * (travel_rate**2).sum(axis=1),
        "air": air_n * v,
    }
    net_j = np.trapezoid(into - sum(lost.values()), t["time_s"])
    assert np.trapezoid(lost["dampers"], t["time_s"]) > 1.0
    # A part in a million: without the dampers' 4 J, or any other share, it fails.
    assert stored[-1] - stored[0] == pytest.approx(net_j, abs=0.01)
