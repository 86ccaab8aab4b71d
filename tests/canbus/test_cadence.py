"""Which cycles are given up and which frames are too many."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tcs_hil.canbus.cadence import GRACE_CYCLES, LENIENT_START, Cadence

CYCLE = 2_000_000


def played(arrivals_ns, until_ns=None, cycle_ns=CYCLE):
    """Missed cycles and superfluous frames of a message with these times of arrival."""
    cadence, missed, superfluous = Cadence(cycle_ns), 0, 0
    for arrival_ns in arrivals_ns:
        missed += cadence.missed(arrival_ns)
        superfluous += not cadence.arrive(arrival_ns)
    if until_ns is not None:
        missed += cadence.missed(until_ns)
    return missed, superfluous


def test_before_the_first_frame_nothing_is_missed():
    assert Cadence(CYCLE).missed(10**18) == 0


def test_the_first_frame_is_expected_whenever_it_comes():
    assert Cadence(CYCLE).arrive(10**18)


def test_a_frame_a_cycle_is_neither_missed_nor_too_many():
    assert played(range(0, 1000 * CYCLE, CYCLE)) == (0, 0)


@pytest.mark.parametrize(
    ("silent_cycles", "missed"), [(0, 0), (1, 0), (2, 1), (3, 2), (1002, 1001)]
)
def test_silence_is_missed_cycle_by_cycle(silent_cycles, missed):
    assert played([0], until_ns=silent_cycles * CYCLE) == (missed, 0)
    assert played([0], until_ns=silent_cycles * CYCLE + CYCLE - 1) == (missed, 0)


def test_a_cycle_is_missed_once_however_often_one_asks():
    cadence = Cadence(CYCLE)
    cadence.arrive(0)
    assert [cadence.missed(5 * CYCLE) for _ in range(3)] == [4, 0, 0]


def test_every_lost_frame_is_missed():
    assert played(n * CYCLE for n in range(1000) if n % 10) == (100 - 1, 0)


def test_frames_delayed_by_two_cycles_and_delivered_together_are_neither():
    arrivals = sorted(n - n % 3 + 2 for n in range(1, 900))
    missed, superfluous = played([n * CYCLE for n in arrivals])
    assert missed <= 2
    assert superfluous <= 2


@given(st.lists(st.integers(0, 2 * CYCLE), min_size=100, max_size=100))
def test_jitter_of_two_cycles_costs_at_most_the_learning_of_the_phase(jitter_ns):
    arrivals, newest = [], 0
    for n, late_ns in enumerate(jitter_ns):
        newest = max(newest, n * CYCLE + late_ns)  # a bus keeps the order
        arrivals.append(newest)
    missed, superfluous = played(arrivals)
    assert missed <= GRACE_CYCLES - 1
    assert superfluous <= GRACE_CYCLES - 1


def test_a_second_sender_makes_half_of_the_frames_too_many():
    arrivals = range(0, 200 * CYCLE, CYCLE // 2)
    assert played(arrivals) == (0, 200 - LENIENT_START)


@pytest.mark.parametrize("drift", [0.99, 1.01])
def test_a_clock_that_drifts_costs_what_it_drifts_and_no_more(drift):
    cycles = 2000
    missed, superfluous = played([round(n * CYCLE * drift) for n in range(cycles)])
    assert missed + superfluous <= abs(1 - drift) * cycles + GRACE_CYCLES


@pytest.mark.parametrize("back_cycles", [1, GRACE_CYCLES])
def test_a_stamp_a_little_out_of_order_changes_nothing(back_cycles):
    cadence = Cadence(CYCLE)
    cadence.arrive(10 * CYCLE)
    assert cadence.missed((10 - back_cycles) * CYCLE) == 0
    assert cadence.missed(12 * CYCLE) == 1


@pytest.mark.parametrize("back_ns", [GRACE_CYCLES * CYCLE + 1, 10**18])
def test_a_clock_that_was_turned_back_starts_the_count_anew(back_ns):
    cadence = Cadence(CYCLE)
    cadence.arrive(10**18)
    assert cadence.missed(10**18 + 10 * CYCLE) == 9
    assert cadence.arrive(10**18 + 10 * CYCLE)
    now_ns = 10**18 + 10 * CYCLE - back_ns
    assert cadence.missed(now_ns) == 0
    assert cadence.missed(now_ns + CYCLE) == 0
    assert cadence.missed(now_ns + 3 * CYCLE) == 2


def test_one_stamp_from_the_far_future_does_not_stop_the_count():
    ordinary = [n * CYCLE for n in range(20)]
    cadence = Cadence(CYCLE)
    cadence.arrive(0)
    cadence.missed(10**18)
    cadence.arrive(10**18)
    for now_ns in ordinary:
        assert cadence.missed(now_ns) == 0
        assert cadence.arrive(now_ns)
    assert cadence.missed(19 * CYCLE + 10 * CYCLE) == 10 - (GRACE_CYCLES - 1)
