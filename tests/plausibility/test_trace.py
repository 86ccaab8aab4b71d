import math

import pytest

from tcs_hil.plausibility.trace import Duration, SpeedTrace, far, near

PERIOD_S = 0.002
RATE_MPS2 = 16.0  # 0.032 m/s in a tick


def trace_at(speed_mps: float, stood_ticks: int = 0, other_mps: float = 10.0) -> SpeedTrace:
    trace = SpeedTrace(RATE_MPS2, PERIOD_S)
    for _ in range(stood_ticks + 1):
        take(trace, speed_mps, other_mps)
    return trace


def take(trace: SpeedTrace, speed_mps: float, other_mps: float = 10.0) -> bool:
    """One tick; whether it is stuck."""
    trace.take(speed_mps)
    return trace.stuck_beside(other_mps)


def test_a_duration_is_reached_after_its_ticks_and_stays() -> None:
    duration = Duration(0.006, PERIOD_S)
    assert [duration.reached(True) for _ in range(5)] == [False, False, True, True, True]


def test_a_moment_without_costs_two_ticks() -> None:
    duration = Duration(0.006, PERIOD_S)
    answers = [duration.reached(holds) for holds in (True, True, True, False, True, True, True)]
    assert answers == [False, False, True, False, False, True, True]


def test_a_duration_never_owes_anything() -> None:
    duration = Duration(0.004, PERIOD_S)
    for _ in range(9):
        duration.reached(False)
    assert [duration.reached(True) for _ in range(2)] == [False, True]


# At 10 m/s after one tick: 2 x 0.032 by the rate, 0.1 and 6 % by the edges.
MOST_MPS = 0.064 + 0.1 + 0.6


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("share", "jumped"), [(0.92, False), (1.01, True)])
def test_what_a_wheel_cannot_gain_or_lose_in_a_tick_is_a_jump(
    sign: float, share: float, jumped: bool
) -> None:
    trace = trace_at(10.0)
    trace.take(10.0 + sign * share * MOST_MPS)
    assert trace.jumped == jumped


def test_a_value_that_has_stood_may_change_by_more() -> None:
    for stood_ticks, jumped in ((0, True), (9, True), (10, False)):
        trace = trace_at(10.0, stood_ticks)
        trace.take(11.07)
        assert trace.jumped == jumped


def test_a_jump_is_one_for_one_tick_and_what_follows_is_measured_from_there() -> None:
    trace = trace_at(10.0)
    trace.take(20.0)
    assert trace.jumped
    trace.take(20.0)
    assert not trace.jumped
    trace.take(20.1)
    assert not trace.jumped
    assert trace.change_mps == pytest.approx(0.1)


@pytest.mark.parametrize("speed_mps", [math.nan, 50.0])
def test_a_speed_that_comes_or_goes_is_no_jump(speed_mps: float) -> None:
    trace = trace_at(10.0)
    trace.take(math.nan)
    assert not trace.jumped
    trace.take(speed_mps)
    assert not trace.jumped


def test_a_value_is_stuck_when_it_stands_on_a_way_on_which_the_other_moves() -> None:
    trace = trace_at(10.0, stood_ticks=9)
    stuck = [take(trace, 10.0, 11.0) for _ in range(3)]
    assert stuck == [False, True, True]  # 0.2 m are ten ticks
    assert not take(trace, 10.01, 11.0)


def test_two_values_that_stand_together_are_not_stuck() -> None:
    trace = trace_at(10.0, stood_ticks=99)
    assert not take(trace, 10.0, 10.89)  # 0.4 and 5 % of 10
    assert take(trace, 10.0, 10.91)


def test_the_other_is_compared_with_what_it_was_when_this_one_last_moved() -> None:
    trace = trace_at(5.0, other_mps=5.0)
    assert not any(take(trace, 10.0, 11.0) for _ in range(30))
    assert take(trace, 10.0, 12.0)


def test_a_standing_car_and_one_without_another_sensor_are_not_stuck() -> None:
    assert not take(trace_at(0.0, stood_ticks=500, other_mps=0.0), 0.0, 9.0)
    assert not take(trace_at(10.0, stood_ticks=500, other_mps=math.nan), 10.0, 5.0)
    assert not take(trace_at(10.0, stood_ticks=500), 10.0, math.nan)


@pytest.mark.parametrize(
    ("speed_mps", "agree"), [(10.89, True), (9.11, True), (10.91, False), (9.09, False)]
)
def test_speeds_are_near_or_far(speed_mps: float, agree: bool) -> None:
    assert near(speed_mps, 10.0) == agree
    assert far(speed_mps, 10.0) == (not agree)
    assert near(speed_mps, 10.0, 0.1)


def test_an_unknown_speed_is_neither_near_nor_far() -> None:
    for pair in ((math.nan, 1.0), (1.0, math.nan)):
        assert not near(*pair)
        assert not far(*pair)
