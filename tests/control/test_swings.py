"""Turns of a signal that swings, and its mean."""

from __future__ import annotations

import math

import pytest

from tcs_hil.control.swings import SLOWEST_SWING_S, SwingMean, Swings

PERIOD_S = 0.002


def turns_of(frequency_hz: float, *, decay: float = 1.0, size: float = 1.0) -> int:
    """Turns counted in 3.25 periods of a sine whose amplitude falls by ``decay`` a period."""
    swings = Swings(PERIOD_S)
    for tick in range(round(3.25 / frequency_hz / PERIOD_S)):
        cycles = tick * PERIOD_S * frequency_hz
        swings.update(0.5 * size * decay**cycles * math.sin(2.0 * math.pi * cycles), least=0.5)
    return swings.turns


@pytest.mark.parametrize("frequency_hz", [3.0, 10.0, 30.0])
def test_every_turn_of_a_lasting_swing_counts(frequency_hz: float) -> None:
    assert turns_of(frequency_hz) == 6


def test_ripple_does_not_count() -> None:
    assert turns_of(10.0, size=0.4) == 0


def test_a_slow_swing_starts_the_row_anew() -> None:
    assert turns_of(0.4 / SLOWEST_SWING_S) == 1


def test_swings_that_die_away_count_no_further_than_the_first_period() -> None:
    assert turns_of(10.0, decay=0.8, size=4.0) == 3


def test_a_row_is_forgotten_when_the_signal_rests() -> None:
    swings = Swings(PERIOD_S)
    for value in (1.0, 0.0, 1.0, 0.0):
        swings.update(value, least=0.5)
    assert swings.turns == 3
    for _ in range(round(2.0 * SLOWEST_SWING_S / PERIOD_S) + 1):
        swings.update(0.0, least=0.5)
    assert swings.turns == 0


def test_reset_forgets_the_row() -> None:
    swings = Swings(PERIOD_S)
    for value in (1.0, 0.0, 1.0, 0.0):
        swings.update(value, least=0.5)
    swings.reset()
    assert swings.turns == 0
    assert not swings.update(0.0, least=0.5)


def test_the_mean_is_taken_over_the_last_two_whole_swings() -> None:
    mean = SwingMean()
    for value, turned in ((9.0, False), (4.0, True), (4.0, False), (1.0, True), (7.0, True)):
        mean.add(value, turned=turned)
    assert mean.value == pytest.approx((4.0 + 4.0 + 1.0) / 3.0)
    mean.reset()
    assert mean.value == 0.0
