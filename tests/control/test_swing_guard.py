"""The hold that ends a limit cycle while it begins."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from msgspec.structs import replace

from tcs_hil.control.protocol import WheelState
from tcs_hil.control.swing_guard import GROWTH_S, HOLD_S, SwingGuard
from tcs_hil.model.vehicle import Vehicle
from tests.control.recorder import wheel_at

PERIOD_S, REQUEST_NM, MEAN_NM, FORCE_N = 0.002, 250.0, 100.0, 900.0
ARM_M = 0.318 / 3.0
CALM = replace(wheel_at(3.0, 0.05, MEAN_NM), tyre_force_n=FORCE_N)

Torque = Callable[[float], float]


@pytest.fixture
def guard() -> SwingGuard:
    return SwingGuard(0.1, Vehicle(), PERIOD_S)


def swing(amplitude_nm: float, frequency_hz: float = 10.0) -> Torque:
    return lambda time_s: MEAN_NM + amplitude_nm * math.sin(2.0 * math.pi * frequency_hz * time_s)


def held_after(
    guard: SwingGuard, torque_at: Torque, wheel: WheelState = CALM, request_nm: float = REQUEST_NM
) -> float:
    """Seconds of a swinging torque until the guard holds; infinite if it does not in a second."""
    for tick in range(500):
        torque_nm = torque_at(tick * PERIOD_S)
        guard.ceiling_nm(replace(wheel, motor_torque_nm=torque_nm), request_nm, torque_nm)
        if guard.holds:
            return tick * PERIOD_S
    return math.inf


def after(guard: SwingGuard, wheel: WheelState, duration_s: float) -> float:
    for _ in range(round(duration_s / PERIOD_S)):
        most_nm = guard.ceiling_nm(wheel, REQUEST_NM, MEAN_NM)
    return most_nm


def hold_s(guard: SwingGuard, wheel: WheelState = CALM) -> float:
    ticks = 0
    while guard.holds:
        guard.ceiling_nm(wheel, REQUEST_NM, MEAN_NM)
        ticks += 1
    return ticks * PERIOD_S


def test_a_steady_torque_leaves_the_whole_request(guard: SwingGuard) -> None:
    assert after(guard, CALM, 1.0) == REQUEST_NM
    assert not guard.holds


def test_a_lasting_swing_is_held_within_three_periods_a_little_below_its_mean(
    guard: SwingGuard,
) -> None:
    assert held_after(guard, swing(30.0)) < 0.3
    assert 0.85 * MEAN_NM < after(guard, CALM, HOLD_S - 0.05) < MEAN_NM


def test_small_and_slow_and_dying_swings_are_left_to_the_law(guard: SwingGuard) -> None:
    assert held_after(guard, swing(4.0)) == math.inf
    guard.reset()
    assert held_after(guard, swing(30.0, frequency_hz=1.5)) == math.inf
    guard.reset()
    wave = swing(60.0)
    dying = [
        MEAN_NM + math.exp(-16.0 * t) * (wave(t) - MEAN_NM) for t in (0.002 * i for i in range(500))
    ]
    assert held_after(guard, lambda t: dying[round(t / PERIOD_S)]) == math.inf


def test_a_smaller_torque_is_held_if_slip_swings_with_it(guard: SwingGuard) -> None:
    def step(tick: int, slip_share: float) -> None:
        wave = math.sin(2.0 * math.pi * 10.0 * tick * PERIOD_S)
        torque_nm = MEAN_NM + 7.0 * wave
        wheel = replace(CALM, motor_torque_nm=torque_nm, slip_ratio=0.1 + slip_share * wave)
        guard.ceiling_nm(wheel, REQUEST_NM, torque_nm)

    for tick in range(200):
        step(tick, slip_share=0.01)
    assert not guard.holds
    for tick in range(200):
        step(tick, slip_share=0.05)
        if guard.holds:
            return
    pytest.fail("slip and torque swing together, and nothing is held")


def test_the_driver_swinging_his_request_is_not_held(guard: SwingGuard) -> None:
    for tick in range(500):
        torque_nm = swing(30.0)(tick * PERIOD_S)
        guard.ceiling_nm(replace(CALM, motor_torque_nm=torque_nm), torque_nm, torque_nm)
        assert not guard.holds


def test_a_wheel_that_swings_while_the_road_gives_more_is_not_held(guard: SwingGuard) -> None:
    road = replace(wheel_at(6.0, 0.1, MEAN_NM), tyre_force_n=FORCE_N)
    after(guard, road, 1.0)  # held at the reference
    for tick in range(100):
        time_s = tick * PERIOD_S
        kick = replace(road, slip_ratio=0.02, tyre_force_n=9.0e4 * time_s)
        wheel = replace(kick, motor_torque_nm=swing(60.0)(time_s))
        guard.ceiling_nm(wheel, REQUEST_NM, MEAN_NM)
        assert not guard.holds


def test_what_a_stab_sets_swinging_has_time_to_die_away() -> None:
    stab_rings_s = 0.1
    guard = SwingGuard(0.1, Vehicle(), PERIOD_S, stab_rings_s)
    after(guard, CALM, 2.0 * stab_rings_s)
    unprovoked_s = held_after(guard, swing(30.0))
    guard.reset()
    after(guard, CALM, 2.0 * stab_rings_s)
    provoked_s = held_after(guard, swing(30.0), request_nm=REQUEST_NM - 50.0)
    # The swings are 50 ms long, and counting begins anew in the middle of one.
    assert provoked_s == pytest.approx(unprovoked_s + stab_rings_s, abs=0.05)


def test_after_the_hold_the_ceiling_grows_until_it_binds_no_more(guard: SwingGuard) -> None:
    held_after(guard, swing(30.0))
    hold_s(guard)
    begin_nm = after(guard, CALM, PERIOD_S)
    assert after(guard, CALM, 0.5 * GROWTH_S) == pytest.approx(begin_nm * math.exp(0.5), rel=0.02)
    assert after(guard, CALM, 2.0) == REQUEST_NM


def test_a_loop_that_swings_again_is_held_for_longer(guard: SwingGuard) -> None:
    held_after(guard, swing(30.0))
    first_s = hold_s(guard)
    held_after(guard, swing(30.0))
    assert hold_s(guard) > 1.2 * first_s
    after(guard, CALM, 5.0)
    held_after(guard, swing(30.0))
    assert hold_s(guard) == pytest.approx(first_s, abs=2 * PERIOD_S)


def test_a_wheel_that_slides_in_the_hold_gets_less_than_its_tyre_carries(
    guard: SwingGuard,
) -> None:
    held_after(guard, swing(30.0))
    slides = replace(wheel_at(3.0, 0.3, MEAN_NM), tyre_force_n=700.0)
    assert after(guard, slides, HOLD_S - 0.05) < 700.0 * ARM_M
    assert guard.holds


def test_a_wheel_that_is_lost_in_the_hold_is_given_to_the_law(guard: SwingGuard) -> None:
    held_after(guard, swing(30.0))
    guard.ceiling_nm(replace(wheel_at(3.0, 0.6), tyre_force_n=FORCE_N), REQUEST_NM, MEAN_NM)
    assert not guard.holds


def test_a_torque_at_the_request_is_held_too(guard: SwingGuard) -> None:
    clipped = swing(40.0)
    assert held_after(guard, lambda t: min(clipped(t), 110.0), request_nm=110.0) < 0.4
    assert after(guard, CALM, 0.1) < 110.0


def test_without_motor_and_force_the_torque_sent_tells_of_swings(guard: SwingGuard) -> None:
    blind = wheel_at(3.0, 0.05, math.nan)
    for tick in range(200):
        guard.ceiling_nm(blind, REQUEST_NM, swing(30.0)(tick * PERIOD_S))
        if guard.holds:
            break
    assert guard.holds
    slides = wheel_at(3.0, 0.3, math.nan)
    assert 0.5 * MEAN_NM < after(guard, slides, HOLD_S - 0.05) < MEAN_NM


def test_reset_forgets_hold_and_ceiling(guard: SwingGuard) -> None:
    held_after(guard, swing(30.0))
    guard.reset()
    assert not guard.holds
    assert guard.ceiling_nm(CALM, REQUEST_NM, MEAN_NM) == REQUEST_NM
