"""The kick of a better road, told from a swing of the loop."""

from __future__ import annotations

import math

import pytest
from msgspec.structs import replace

from tcs_hil.control.friction_rise import HELD_S, KICK_S, SLOWEST_MPS, FrictionRise
from tests.control.recorder import wheel_at

PERIOD_S, FORCE_N = 0.002, 600.0
HELD = replace(wheel_at(5.0, 0.1), tyre_force_n=FORCE_N)
KICKED = replace(wheel_at(5.0, -0.05), tyre_force_n=2.0 * FORCE_N)


@pytest.fixture
def rise() -> FrictionRise:
    return FrictionRise(0.1, PERIOD_S)


def hold(rise: FrictionRise, duration_s: float) -> None:
    for _ in range(round(duration_s / PERIOD_S)):
        assert not rise.shows(HELD, FORCE_N)


def test_a_tyre_that_pushes_much_more_than_the_held_wheel_did_shows_another_road(
    rise: FrictionRise,
) -> None:
    hold(rise, 2.0 * HELD_S)
    assert rise.shows(KICKED, FORCE_N)


@pytest.mark.parametrize("force_n", [1.2 * FORCE_N, math.nan], ids=["hardly more", "unknown"])
def test_a_force_that_hardly_rises_shows_nothing(rise: FrictionRise, force_n: float) -> None:
    hold(rise, 2.0 * HELD_S)
    assert not rise.shows(replace(KICKED, tyre_force_n=force_n), FORCE_N)


def test_in_a_launch_the_force_rises_on_the_same_road(rise: FrictionRise) -> None:
    for tick in range(500):  # kappa swings at 10 Hz about its reference
        kappa = 0.1 + 0.1 * math.sin(2.0 * math.pi * 10.0 * tick * PERIOD_S)
        assert not rise.shows(replace(KICKED, slip_ratio=kappa), FORCE_N)


def test_a_wheel_that_swings_while_it_is_held_shows_nothing(rise: FrictionRise) -> None:
    hold(rise, 2.0 * HELD_S)
    assert not rise.shows(replace(HELD, tyre_force_n=2.0 * FORCE_N), FORCE_N)


def test_what_was_held_long_ago_tells_nothing_of_the_force_now(rise: FrictionRise) -> None:
    hold(rise, 2.0 * HELD_S)
    for _ in range(round(KICK_S / PERIOD_S)):
        rise.shows(replace(KICKED, tyre_force_n=FORCE_N), FORCE_N)
    assert not rise.shows(KICKED, FORCE_N)


def test_near_walking_pace_every_swing_is_left_to_the_guard(rise: FrictionRise) -> None:
    hold(rise, 2.0 * HELD_S)
    assert not rise.shows(replace(KICKED, vehicle_speed_mps=0.99 * SLOWEST_MPS), FORCE_N)


def test_reset_forgets_that_the_wheel_was_held(rise: FrictionRise) -> None:
    hold(rise, 2.0 * HELD_S)
    rise.reset()
    assert not rise.shows(KICKED, FORCE_N)
