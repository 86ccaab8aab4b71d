import math
from itertools import product

import pytest

from tcs_hil.plausibility.driven import DrivenWheel, MotorTorque

PERIOD_S = 0.002
ROLLING_MPS = 10.0


def drive(wheel: DrivenWheel, wheel_mps: float, motor_mps: float, ticks: int) -> float:
    """The rim's speed after some ticks, with a ripple on both, for real sensors never stand."""
    rim_mps = math.nan
    for tick in range(ticks):
        ripple_mps = 0.001 * (tick % 2)
        rim_mps = wheel.take(wheel_mps + ripple_mps, motor_mps + ripple_mps, ROLLING_MPS)
    return rim_mps


@pytest.fixture
def wheel() -> DrivenWheel:
    turning = DrivenWheel(PERIOD_S)
    drive(turning, 11.0, 11.0, 200)
    return turning


def suspected(wheel: DrivenWheel) -> tuple[bool, bool]:
    return wheel.wheel_suspected, wheel.motor_suspected


def test_wheel_and_motor_that_turn_together_are_believed(wheel: DrivenWheel) -> None:
    assert suspected(wheel) == (False, False)


def test_a_spinning_wheel_is_believed_as_long_as_its_motor_spins_too(wheel: DrivenWheel) -> None:
    for tick in range(200):
        wheel.take(11.0 + 0.2 * tick, 11.0 + 0.2 * tick, ROLLING_MPS)
    assert suspected(wheel) == (False, False)


def test_a_shaft_that_swings_is_no_contradiction(wheel: DrivenWheel) -> None:
    for tick in range(500):  # 25 Hz
        swing_mps = 3.0 * math.sin(2.0 * math.pi * tick / 20.0)
        wheel.take(11.0 + swing_mps, 11.0 - 0.1 * swing_mps, ROLLING_MPS)
    assert suspected(wheel) == (False, False)


@pytest.mark.parametrize(
    ("gap_mps", "apart"), [(1.8, False), (2.2, True), (-1.7, False), (-1.8, True)]
)
def test_only_what_is_too_far_apart_is_suspected(
    wheel: DrivenWheel, gap_mps: float, apart: bool
) -> None:
    drive(wheel, 11.0 + gap_mps, 11.0, 100)
    assert any(suspected(wheel)) == apart


def test_it_takes_50_ms(wheel: DrivenWheel) -> None:
    drive(wheel, 20.0, 11.0, 24)
    assert suspected(wheel) == (False, False)
    drive(wheel, 20.0, 11.0, 1)
    assert suspected(wheel) == (True, False)


def test_the_sensor_that_stepped_is_the_wrong_one(wheel: DrivenWheel) -> None:
    drive(wheel, 11.0, 20.0, 25)
    assert suspected(wheel) == (False, True)


def test_a_step_back_does_not_acquit(wheel: DrivenWheel) -> None:
    drive(wheel, 20.0, 11.0, 10)
    drive(wheel, 19.9, 11.0, 30)
    assert suspected(wheel) == (True, False)


def part(wheel: DrivenWheel, wheel_mps: float, motor_mps: float) -> None:
    """Let the two drift apart slowly, so that neither steps."""
    ticks = 400
    for tick in range(ticks + 50):
        share = min(tick / ticks, 1.0)
        ripple_mps = 0.001 * (tick % 2)
        wheel.take(
            11.0 + share * (wheel_mps - 11.0) + ripple_mps,
            11.0 + share * (motor_mps - 11.0) + ripple_mps,
            ROLLING_MPS,
        )


def test_the_one_that_is_slower_than_the_rolling_wheels_is_wrong(wheel: DrivenWheel) -> None:
    part(wheel, 6.0, 11.0)
    assert suspected(wheel) == (True, False)


def test_without_evidence_both_are_suspected(wheel: DrivenWheel) -> None:
    part(wheel, 15.0, 11.0)
    assert suspected(wheel) == (True, True)


def test_evidence_against_both_is_none(wheel: DrivenWheel) -> None:
    part(wheel, 5.0, 2.0)
    assert suspected(wheel) == (True, True)


@pytest.mark.parametrize("stuck", [0, 1])
def test_the_one_that_stands_still_while_the_other_moves_is_wrong(
    wheel: DrivenWheel, stuck: int
) -> None:
    for tick in range(100):
        moving = 11.0 + 0.02 * tick
        speeds = (11.0, moving) if stuck == 0 else (moving, 11.0)
        wheel.take(*speeds, ROLLING_MPS)
    assert suspected(wheel) == (stuck == 0, stuck == 1)


def test_the_rim_is_read_from_the_motor_unless_that_is_unknown_or_wrong(
    wheel: DrivenWheel,
) -> None:
    assert drive(wheel, 11.2, 11.0, 1) == 11.0
    assert drive(wheel, 11.2, math.nan, 1) == 11.2
    drive(wheel, 11.0, 20.0, 40)
    assert drive(wheel, 11.2, 20.0, 1) == 11.2


def test_both_are_believed_again_after_100_ms_together(wheel: DrivenWheel) -> None:
    drive(wheel, 20.0, 11.0, 25)
    drive(wheel, 11.0, 11.0, 49)
    assert suspected(wheel) == (True, False)
    drive(wheel, 11.0, 11.0, 1)
    assert suspected(wheel) == (False, False)


def test_two_that_stand_beside_each_other_do_not_heal(wheel: DrivenWheel) -> None:
    for tick in range(100):
        wheel.take(11.0, 11.0 + 0.02 * tick, ROLLING_MPS)
    for tick in range(100):
        wheel.take(11.0, 12.4 - 0.001 * (tick % 2), ROLLING_MPS)
    assert wheel.wheel_suspected


def test_a_step_is_forgotten_after_200_ms(wheel: DrivenWheel) -> None:
    wheel.take(12.0, 11.0, ROLLING_MPS)  # a step too small to be suspicious
    drive(wheel, 12.0, 11.0, 101)
    part(wheel, 15.0, 11.0)
    assert suspected(wheel) == (True, True)


@pytest.mark.parametrize(("left", "right"), [*product((math.nan, 11.0), repeat=2)])
def test_what_is_unknown_contradicts_nothing(left: float, right: float) -> None:
    wheel = DrivenWheel(PERIOD_S)
    drive(wheel, left, right, 100)
    assert suspected(wheel) == (False, False)


def torque(*values: tuple[float, float]) -> MotorTorque:
    motor = MotorTorque(PERIOD_S)
    for given_nm, allowed_nm in values:
        motor.take(given_nm, allowed_nm)
    return motor


def test_a_torque_that_flutters_is_suspected() -> None:
    flutter = [(100.0 * (tick % 2), 100.0) for tick in range(10)]
    assert not torque(*flutter).suspected  # the first value is no change
    assert torque(*flutter, (100.0 * (len(flutter) % 2), 100.0)).suspected


def test_a_motor_may_swing_as_fast_as_its_lag_lets_it() -> None:
    swing = [(250.0 * (1.0 - math.exp(-0.4 * (tick % 15))), 250.0) for tick in range(500)]
    assert not torque(*swing).suspected


def test_a_motor_that_gives_nothing_of_much_is_suspected_after_100_ms() -> None:
    assert not torque(*[(5.9, 60.0)] * 49).suspected
    assert torque(*[(5.9, 60.0)] * 50).suspected
    assert not torque(*[(6.1, 60.0)] * 99).suspected
    assert not torque(*[(0.0, 50.0)] * 99).suspected


def test_a_torque_is_believed_again_100_ms_after_it_was_last_wrong() -> None:
    mute = [(0.0, 60.0)] * 60
    assert torque(*mute, *[(60.0, 60.0)] * 49).suspected
    assert not torque(*mute, *[(60.0, 60.0)] * 50).suspected


def test_an_unknown_torque_is_not_suspected() -> None:
    assert not torque(*[(math.nan, 100.0)] * 99).suspected
