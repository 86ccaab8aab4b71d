"""The ceiling on the torque after a wheel has broken away."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from tcs_hil.control.break_away import GROWTH_S, HOLD_S, BreakAway
from tcs_hil.control.protocol import WheelState
from tcs_hil.model.vehicle import Vehicle
from tests.control.recorder import wheel_at

PERIOD_S, REQUEST_NM, FORCE_N = 0.002, 250.0, 1000.0
CARRIED_NM = FORCE_N * 0.318 / 3.0
STICKS = replace(wheel_at(2.0, 0.05), tyre_force_n=FORCE_N)
SLIDES = replace(wheel_at(2.0, 0.3), tyre_force_n=FORCE_N)


@pytest.fixture
def ceiling() -> BreakAway:
    return BreakAway(0.1, Vehicle(), PERIOD_S)


def after(ceiling: BreakAway, wheel: WheelState, duration_s: float, sent_nm: float = 0.0) -> float:
    for _ in range(round(duration_s / PERIOD_S)):
        most_nm = ceiling.ceiling_nm(wheel, REQUEST_NM, sent_nm)
    return most_nm


def test_a_wheel_that_holds_has_the_whole_request(ceiling: BreakAway) -> None:
    assert after(ceiling, STICKS, 1.0) == REQUEST_NM


def test_a_wheel_that_breaks_away_gets_less_than_its_tyre_carries(ceiling: BreakAway) -> None:
    after(ceiling, STICKS, 0.5)
    assert after(ceiling, SLIDES, 0.1) == pytest.approx(0.95 * CARRIED_NM, rel=1e-3)


def test_the_ceiling_is_held_for_a_while_and_then_grows_until_it_binds_no_more(
    ceiling: BreakAway,
) -> None:
    after(ceiling, STICKS, 0.5)
    held_nm = after(ceiling, SLIDES, 0.1)
    assert after(ceiling, STICKS, HOLD_S - PERIOD_S) == pytest.approx(held_nm, rel=1e-4)
    assert after(ceiling, STICKS, 0.5 * GROWTH_S) == pytest.approx(1.65 * held_nm, rel=0.02)
    assert after(ceiling, STICKS, 1.0) == REQUEST_NM


def test_a_force_seen_too_late_does_not_take_all_torque(ceiling: BreakAway) -> None:
    unseen = replace(SLIDES, tyre_force_n=0.0)
    assert ceiling.ceiling_nm(unseen, REQUEST_NM, 100.0) == pytest.approx(70.0)
    assert ceiling.ceiling_nm(unseen, REQUEST_NM, 60.0) == pytest.approx(70.0)


def test_a_force_that_builds_up_after_the_slide_lifts_the_ceiling_at_once(
    ceiling: BreakAway,
) -> None:
    assert ceiling.ceiling_nm(replace(SLIDES, tyre_force_n=0.0), REQUEST_NM, 60.0) == 42.0
    assert after(ceiling, STICKS, HOLD_S - PERIOD_S) == pytest.approx(0.95 * CARRIED_NM, rel=0.01)


@pytest.mark.parametrize(
    "wheel",
    [wheel_at(6.0, 0.5), wheel_at(0.3, 0.3), wheel_at(2.0, 0.15)],
    ids=["quick", "hardly moving", "hardly slipping"],
)
def test_what_the_law_can_hold_alone_is_left_to_it(ceiling: BreakAway, wheel: WheelState) -> None:
    assert after(ceiling, wheel, 0.2) == REQUEST_NM


def test_a_wheel_without_a_known_force_is_bounded_by_what_was_sent(ceiling: BreakAway) -> None:
    blind = wheel_at(2.0, 0.3)
    assert ceiling.ceiling_nm(blind, REQUEST_NM, 100.0) == pytest.approx(70.0)


def test_reset_forgets_the_ceiling(ceiling: BreakAway) -> None:
    after(ceiling, SLIDES, 0.1)
    ceiling.reset()
    assert ceiling.ceiling_nm(STICKS, REQUEST_NM, 0.0) == REQUEST_NM
