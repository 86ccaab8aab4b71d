"""Noise, bias and validity of what the car's electronics read."""

import numpy as np
import pytest

QUIET = {
    "teeth": 0,
    "motor_speed_noise_radps": 0.0,
    "motor_torque_noise_nm": 0.0,
    "accel_noise_mps2": 0.0,
    "accel_bias_mps2": 0.0,
}


def samples(plant, count):
    read = []
    for _ in range(count):
        plant.step(None, 0.002)
        read.append(plant.signals())
    return read


def test_ideal_sensors_tell_the_truth(drive):
    plant = drive([[0.0, 80.0]], sensors=QUIET, start_speed_kmph=10.0)
    (read,) = samples(plant, 1)
    truth = plant.truth
    assert read.wheel_speed_radps == pytest.approx(truth.wheel_speed_radps)
    assert read.motor_speed_radps == pytest.approx(truth.motor_speed_radps)
    assert read.motor_torque_nm == pytest.approx(truth.motor_torque_nm)
    assert read.driver_torque_nm == (80.0, 80.0)
    assert read.accel_x_mps2 == pytest.approx(truth.accel_mps2 + 9.81 * truth.pitch_rad)


def test_the_accelerometer_feels_the_grade(drive):
    plant = drive(sensors=QUIET, road=[{"mu": 1.0, "grade": 0.1}])
    (read,) = samples(plant, 1)
    sine = 0.1 / np.hypot(1.0, 0.1)
    assert read.accel_x_mps2 == pytest.approx(9.81 * (sine + plant.truth.pitch_rad), abs=1e-3)


def test_noise_has_the_stated_deviation_and_bias(drive):
    sensors = {"accel_bias_mps2": 0.2, "accel_noise_mps2": 0.05, "motor_torque_noise_nm": 1.0}
    plant = drive(sensors=sensors)
    read = samples(plant, 2000)
    accel = np.array([signals.accel_x_mps2 for signals in read])
    torque = np.array([signals.motor_torque_nm for signals in read])
    assert accel.mean() == pytest.approx(0.2, abs=0.005)
    assert accel.std() == pytest.approx(0.05, rel=0.06)
    assert torque.std(axis=0) == pytest.approx([1.0, 1.0], rel=0.06)


def test_the_same_seed_gives_the_same_noise_and_another_seed_another(drive):
    first, again, other = (
        samples(drive([[0.0, 50.0]], sensors={"seed": seed}), 50) for seed in (7, 7, 8)
    )
    assert first == again
    assert first != other


def test_without_an_accelerometer_none_is_sent(drive):
    (read,) = samples(drive(sensors={"accelerometer": False}), 1)
    assert read.accel_x_mps2 is None


def test_a_passive_sensor_is_blind_and_invalid_near_standstill(drive):
    plant = drive(sensors={"speed_min_radps": 5.0}, start_speed_kmph=3.0)
    (read,) = samples(plant, 1)
    assert read.wheel_speed_radps == (0.0,) * 4
    assert read.wheel_speed_valid == (False,) * 4


def test_toothed_sensors_start_with_the_speed_of_the_wheels(drive):
    plant = drive(start_speed_kmph=2.0)
    (read,) = samples(plant, 1)
    assert read.wheel_speed_radps == pytest.approx(plant.truth.wheel_speed_radps, rel=0.01)
