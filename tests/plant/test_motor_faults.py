"""What a faulty motor gives, beside a healthy one."""

import numpy as np
import pytest

from tcs_hil.signals import TorqueLimits


def motor(drive, duration_s=0.3, **fault):
    plant = drive(
        [[0.0, 100.0]],
        fault=[{"target": "MotorL", "start_s": 0.1, "end_s": 0.2, **fault}],
        start_speed_kmph=20.0,
    )
    torques = []
    for _ in range(round(duration_s / 0.002)):
        plant.step(TorqueLimits(40.0, 40.0), 0.002)
        torques.append(plant.truth.motor_torque_nm)
    return np.array(torques)


def test_a_motor_that_ignores_its_limit_follows_the_driver(drive):
    torques = motor(drive, kind="ignores-limit")
    assert torques[98] == pytest.approx([100.0, 40.0], abs=0.5)
    assert torques[-1] == pytest.approx([40.0, 40.0], abs=0.5)


def test_a_motor_that_is_off_gives_nothing(drive):
    torques = motor(drive, kind="off")
    assert torques[98] == pytest.approx([0.0, 40.0], abs=0.5)
    assert torques[-1] == pytest.approx([40.0, 40.0], abs=0.5)


def test_a_slow_motor_lags(drive):
    torques = motor(drive, kind="slow", time_constant_s=0.05, start_s=0.0, end_s=1.0)
    assert torques[-1] == pytest.approx([40.0, 40.0], abs=0.5)


MOTOR_VALUE_FAULTS = [
    {"kind": "stuck"},
    {"kind": "garbage"},
    {"kind": "slow", "time_constant_s": 0.03},
    {"kind": "delayed", "delay_s": 0.013},
    {"kind": "intermittent", "period_s": 0.0151, "duty": 0.3},
]


@pytest.mark.parametrize("fault", MOTOR_VALUE_FAULTS, ids=lambda fault: fault["kind"])
def test_a_motor_fault_does_not_depend_on_how_time_is_cut(drive, fault):
    """Of a pedal that moves all the time, so that when it is read matters."""

    def run(dt_s):
        plant = drive(
            [[0.0, 0.0], [1.0, 200.0]],
            fault=[{"target": "MotorL", "start_s": 0.0511, "end_s": 0.1523, **fault}],
            start_speed_kmph=20.0,
        )
        for _ in range(round(0.2 / dt_s)):
            plant.step(None, dt_s)
        return plant.truth.wheel_speed_radps

    assert run(0.0005) == pytest.approx(run(0.02), abs=1e-6)


def test_a_healthy_motor_keeps_its_lines_beside_a_faulty_one(drive):
    """And a fault that is over leaves nothing behind."""
    fault = {"target": "MotorL", "kind": "wrong", "offset": -5.0, "end_s": 0.1}
    healthy, faulty = (
        drive([[0.0, 0.0], [1.0, 200.0]], fault=faults, start_speed_kmph=20.0)
        for faults in ([], [fault])
    )
    for plant in (healthy, faulty):
        plant.step(None, 0.4011)
    asked = [plant.truth.motor_torque_nm for plant in (healthy, faulty)]
    assert asked[0] == pytest.approx(asked[1], abs=1e-6)


def test_a_brown_out_takes_the_torque(drive):
    plant = drive(
        [[0.0, 100.0]],
        fault=[{"target": "VEHICLE", "kind": "brown-out", "start_s": 0.1, "end_s": 0.2}],
        start_speed_kmph=20.0,
    )
    plant.step(None, 0.15)
    assert plant.dark
    assert plant.truth.motor_torque_nm == pytest.approx((0.0, 0.0), abs=0.1)
    plant.step(None, 0.1)
    assert not plant.dark
    assert plant.truth.motor_torque_nm == pytest.approx((100.0, 100.0), abs=0.1)
