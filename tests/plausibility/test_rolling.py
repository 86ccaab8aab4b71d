import math

import pytest

from tcs_hil.plausibility.rolling import RollingAxle

PERIOD_S = 0.002
DRIVE_NM = (100.0, 100.0)
IDLE_NM = (0.0, 0.0)


def roll(
    axle: RollingAxle,
    left_mps: float,
    right_mps: float,
    ticks: int = 1,
    *,
    accel_mps2: float = 0.0,
    gain_mps2: float = 0.0,
    driven_mps: float = math.nan,
    motors_nm: tuple[float, float] = DRIVE_NM,
) -> None:
    """Some ticks at two speeds that grow by ``gain_mps2``; real sensors never stand quite still."""
    for tick in range(ticks):
        more_mps = gain_mps2 * PERIOD_S * tick + 0.001 * (tick % 2)
        axle.take(left_mps + more_mps, right_mps + more_mps, accel_mps2)
        axle.compare(driven_mps, motors_nm)


@pytest.fixture
def axle() -> RollingAxle:
    rolling = RollingAxle(PERIOD_S)
    roll(rolling, 10.0, 10.0, 500)
    return rolling


def suspected(axle: RollingAxle) -> tuple[bool, bool, bool]:
    return axle.left.suspected, axle.right.suspected, axle.accel_suspected


CALM = (False, False, False)
LEFT = (True, False, False)
BOTH = (True, True, False)
ACCEL = (False, False, True)


def test_a_car_that_rolls_is_believed_and_its_speed_known(axle: RollingAxle) -> None:
    assert suspected(axle) == CALM
    assert axle.speed_mps == pytest.approx(10.0, abs=0.01)


def test_a_car_that_gains_speed_is_believed(axle: RollingAxle) -> None:
    roll(axle, 10.0, 10.0, 1000, gain_mps2=9.0, accel_mps2=9.0)
    assert suspected(axle) == CALM
    assert axle.speed_mps == pytest.approx(28.0, abs=0.1)


def test_a_grade_and_a_bias_are_no_contradiction(axle: RollingAxle) -> None:
    roll(axle, 10.0, 10.0, 1000, gain_mps2=3.0, accel_mps2=5.0)
    assert suspected(axle) == CALM


@pytest.mark.parametrize(("left_mps", "who"), [(14.0, LEFT), (6.0, LEFT), (10.5, CALM)])
def test_a_wheel_that_jumps_is_suspected_at_once(
    axle: RollingAxle, left_mps: float, who: tuple[bool, bool, bool]
) -> None:
    roll(axle, left_mps, 10.0)
    assert suspected(axle) == who


def test_a_wheel_faster_than_any_car_is_suspected_although_it_did_not_jump() -> None:
    axle = RollingAxle(PERIOD_S)
    roll(axle, 110.1, 109.9)
    assert suspected(axle) == LEFT


def test_the_other_wheel_carries_the_speed_meanwhile(axle: RollingAxle) -> None:
    roll(axle, 14.0, 10.0, 100)
    assert axle.speed_mps == pytest.approx(10.0, abs=0.01)


def test_a_wheel_that_stands_still_while_the_other_moves_is_suspected(axle: RollingAxle) -> None:
    for tick in range(200):
        axle.take(10.0, 10.0 + 0.01 * tick, 5.0)
        axle.compare(math.nan, DRIVE_NM)
    assert suspected(axle) == LEFT


def drift_apart(axle: RollingAxle, gap_mps: float) -> None:
    """Left gains on right too slowly to jump."""
    for tick in range(2000):
        share = min(tick / 1500, 1.0)
        axle.take(10.0 + share * gap_mps + 0.001 * (tick % 2), 10.0 - 0.001 * (tick % 2), 0.0)
        axle.compare(math.nan, DRIVE_NM)


def test_wheels_may_differ_as_in_a_curve(axle: RollingAxle) -> None:
    drift_apart(axle, 1.8)  # 16 m2/s2 over 10.9 m/s, and 0.4
    assert suspected(axle) == CALM


def test_two_wheels_that_contradict_each_other_are_both_suspected(axle: RollingAxle) -> None:
    drift_apart(axle, 2.0)
    assert suspected(axle)[:2] == (True, True)


def test_at_low_speed_the_tightest_curve_bounds_the_difference() -> None:
    for gap_mps, who in ((0.7, CALM), (1.0, BOTH)):
        axle = RollingAxle(PERIOD_S)
        roll(axle, 1.0, 1.0, 10)
        for tick in range(400):
            share = min(tick / 300, 1.0)
            axle.take(1.0 + share * gap_mps, 1.0 + 0.001 * (tick % 2), 0.0)
        assert suspected(axle) == who


@pytest.mark.parametrize(
    ("left_mps", "motors_nm", "who"),
    [
        (11.0, DRIVE_NM, CALM),  # 1.1 times 9.6 m/s, and 0.5
        (11.2, DRIVE_NM, LEFT),
        (11.2, IDLE_NM, CALM),
        (11.2, (100.0, 5.0), CALM),
        (11.2, (5.0, 100.0), CALM),
        (11.2, (math.nan, math.nan), CALM),
    ],
)
def test_a_wheel_that_is_faster_than_every_driven_one_is_suspected(
    left_mps: float, motors_nm: tuple[float, float], who: tuple[bool, bool, bool]
) -> None:
    axle = RollingAxle(PERIOD_S)
    roll(axle, left_mps, 10.0, 100, driven_mps=9.6, motors_nm=motors_nm)
    assert suspected(axle) == who


def test_it_must_be_so_for_100_ms() -> None:
    axle = RollingAxle(PERIOD_S)
    roll(axle, 11.2, 10.0, 49, driven_mps=9.6)
    assert suspected(axle) == CALM
    roll(axle, 11.2, 10.0, 1, driven_mps=9.6)
    assert suspected(axle) == LEFT


def test_a_car_that_rolls_back_on_a_hill_has_slower_driven_wheels() -> None:
    axle = RollingAxle(PERIOD_S)
    roll(axle, 2.9, 2.9, 100, driven_mps=0.5)
    assert suspected(axle) == CALM


def test_a_wheel_is_believed_again_after_100_ms_at_the_speed_of_the_car(axle: RollingAxle) -> None:
    roll(axle, 14.0, 10.0, 100)
    roll(axle, 10.0, 10.0, 1)  # the jump back
    roll(axle, 10.0, 10.0, 48)
    assert suspected(axle) == LEFT
    roll(axle, 10.0, 10.0, 2)
    assert suspected(axle) == CALM


def test_while_no_wheel_is_believed_the_acceleration_carries_the_speed(axle: RollingAxle) -> None:
    roll(axle, 14.0, 14.0, 1)
    roll(axle, 14.0, 14.0, 200, accel_mps2=2.0)
    assert suspected(axle) == BOTH
    assert axle.speed_mps == pytest.approx(10.8, abs=0.05)


def test_both_wheels_heal_at_the_speed_that_was_carried_on(axle: RollingAxle) -> None:
    roll(axle, 14.0, 14.0, 200, accel_mps2=2.0)
    roll(axle, 10.9, 10.9, 60)
    assert suspected(axle) == CALM


def test_after_a_second_the_carried_speed_heals_nobody(axle: RollingAxle) -> None:
    roll(axle, 14.0, 14.0, 520)
    roll(axle, 10.0, 10.0, 200)
    assert suspected(axle) == BOTH


def test_wheels_that_agree_with_idle_driven_ones_heal_at_any_time(axle: RollingAxle) -> None:
    roll(axle, 14.0, 14.0, 520)
    for motors_nm in (DRIVE_NM, (0.0, 100.0), (-100.0, 0.0)):
        roll(axle, 12.0, 12.0, 100, driven_mps=12.1, motors_nm=motors_nm)
        assert suspected(axle) == BOTH
    roll(axle, 12.0, 12.0, 60, driven_mps=12.1, motors_nm=IDLE_NM)
    assert suspected(axle) == CALM
    assert axle.speed_mps == pytest.approx(12.0, abs=0.02)


@pytest.mark.parametrize("accel_mps2", [20.1, -20.1, math.inf])
def test_an_acceleration_of_no_car_is_suspected_for_a_second(
    axle: RollingAxle, accel_mps2: float
) -> None:
    roll(axle, 10.0, 10.0, 1, accel_mps2=accel_mps2)
    assert suspected(axle) == ACCEL
    roll(axle, 10.0, 10.0, 499)
    assert suspected(axle) == ACCEL
    roll(axle, 10.0, 10.0, 2)
    assert suspected(axle) == CALM
    assert axle.speed_mps == pytest.approx(10.0, abs=0.01)


def test_an_acceleration_that_both_wheels_contradict_is_suspected(axle: RollingAxle) -> None:
    roll(axle, 10.0, 10.0, 500, accel_mps2=-19.0)
    assert axle.accel_suspected
    assert not axle.left.suspected
    assert axle.speed_mps == pytest.approx(10.0, abs=0.1)


def test_below_3_mps_wheels_say_too_little_to_contradict_it() -> None:
    axle = RollingAxle(PERIOD_S)
    roll(axle, 2.9, 2.9, 500, accel_mps2=-19.0)
    assert suspected(axle) == CALM


def test_a_car_without_accelerometer_is_believed(axle: RollingAxle) -> None:
    roll(axle, 10.0, 10.0, 1000, gain_mps2=3.0, accel_mps2=math.nan)
    assert suspected(axle) == CALM


def test_one_wheel_alone_is_enough_for_the_speed(axle: RollingAxle) -> None:
    for left_mps, right_mps in ((math.nan, 11.0), (11.0, math.nan)):
        other = RollingAxle(PERIOD_S)
        roll(other, left_mps, right_mps, 10)
        assert other.speed_mps == pytest.approx(11.0, abs=0.01)
        assert suspected(other) == CALM


def test_without_any_wheel_nothing_is_known_and_nobody_suspected() -> None:
    axle = RollingAxle(PERIOD_S)
    roll(axle, math.nan, math.nan, 1000, accel_mps2=3.0)
    assert suspected(axle) == CALM
    assert math.isnan(axle.speed_mps)


def test_a_standing_car_does_not_roll_back_in_the_books() -> None:
    axle = RollingAxle(PERIOD_S)
    roll(axle, 0.0, 0.0, 10)
    roll(axle, math.nan, math.nan, 100, accel_mps2=-5.0)
    assert axle.speed_mps == 0.0
