"""What the motor tells about its wheel."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tcs_hil.control.driveline import Driveline
from tcs_hil.estimator.driveline_observer import DrivelineObserver, discretised, kalman_gain

PERIOD_S, FINE = 0.002, 20
LINE = Driveline()


def tyre_nm(time_s: float) -> float:
    """Torque of the tyre: grip is lost at 1 s."""
    return 250.0 if time_s < 1.0 else 150.0


def run(
    observer: DrivelineObserver, noise_radps: float = 0.0
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Truth and estimate [omega, omega_motor, twist, tyre torque] per tick under 90 Nm."""
    rng, rows = np.random.default_rng(3), []
    x, h = np.array([10.0, 10.0, 0.0]), PERIOD_S / FINE
    for tick in range(1000):
        time_s, motor_nm = tick * PERIOD_S, 90.0 + 5.0 * math.sin(0.05 * tick)
        seen = observer.update(3.0 * motor_nm, x[1] + noise_radps * rng.standard_normal())
        rows.append((np.array([*x, tyre_nm(time_s)]), np.array(seen)))
        for _ in range(FINE):
            shaft_nm = 6000.0 * x[2] + 25.0 * (x[1] - x[0])
            x = x + h * np.array(
                [
                    (shaft_nm - tyre_nm(time_s)) / 0.95,
                    (3.0 * motor_nm - shaft_nm) / 0.27,
                    x[1] - x[0],
                ]
            )
    return rows


def test_wheel_speed_twist_and_tyre_torque_are_found_through_the_shaft() -> None:
    truth, seen = (
        np.array(part) for part in zip(*run(DrivelineObserver(LINE, PERIOD_S)), strict=True)
    )
    error = np.abs(truth - seen)[300:490]
    assert (error.max(axis=0) < (0.05, 0.02, 0.001, 15.0)).all()


def test_a_lost_grip_is_seen_within_30_ms() -> None:
    _, seen = zip(*run(DrivelineObserver(LINE, PERIOD_S)), strict=True)
    assert seen[515][3] == pytest.approx(150.0, abs=25.0)


def test_noise_of_the_motor_speed_does_not_shake_the_wheel_speed() -> None:
    quiet, noisy = (
        run(DrivelineObserver(LINE, PERIOD_S)),
        run(DrivelineObserver(LINE, PERIOD_S), 0.02),
    )
    shaken = np.array([b[1][0] - a[1][0] for a, b in zip(quiet, noisy, strict=True)])
    assert shaken[100:].std() < 0.06


def test_after_a_reset_the_wheel_turns_like_its_motor_and_the_tyre_takes_its_torque() -> None:
    observer = DrivelineObserver(LINE, PERIOD_S)
    observer.update(0.0, 10.0)
    observer.reset()
    assert observer.update(100.0, 33.0) == [33.0, 33.0, 100.0 / 6000.0, 100.0]


def test_the_observer_forgets_a_wrong_start() -> None:
    a, _ = discretised(LINE, PERIOD_S)
    closed = a - np.outer(kalman_gain(a), a[1])
    assert np.abs(np.linalg.eigvals(closed)).max() < 0.9


def test_the_unrolled_filter_is_the_textbook_one() -> None:
    """Predict with A and b, correct by the gain, in matrices, over random torques and speeds."""
    rng = np.random.default_rng(7)
    observer = DrivelineObserver(LINE, PERIOD_S)
    (a, b), x, input_nm = discretised(LINE, PERIOD_S), np.zeros(4), 0.0
    gain = kalman_gain(a)
    observer.update(0.0, 0.0)
    for torque_nm, speed_radps in zip(*rng.uniform(0.0, 600.0, (2, 500)), strict=True):
        predicted = a @ x + b * 0.5 * (input_nm + torque_nm)
        x = predicted + gain * (speed_radps - predicted[1])
        input_nm = torque_nm
        assert observer.update(torque_nm, speed_radps) == pytest.approx(x.tolist(), rel=1e-9)
