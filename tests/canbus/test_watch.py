"""What a message's state comes to, with the windows of the DBC, whatever the transport does."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.e2e import E2EStatus
from tcs_hil.canbus.watch import MessageWatch
from tcs_hil.signals import InputState

OK, ERROR, REPEATED = E2EStatus.OK, E2EStatus.ERROR, E2EStatus.REPEATED
VALID, INVALID = InputState.VALID, InputState.INVALID
SPEC = load_database().messages["WheelSpeedsRear"]
CYCLE = SPEC.cycle_ns
START = 1_000 * CYCLE


def new_watch():
    return MessageWatch(SPEC.window, CYCLE)


def running_watch(cycles=50):
    """Watch that has seen good frames up to the cycle before ``START``."""
    watch = new_watch()
    for n in range(cycles, 0, -1):
        watch.count(OK, START - n * CYCLE)
        watch.state(START - n * CYCLE)
    assert watch.state(START - CYCLE) is VALID
    return watch


def states(watch, statuses):
    """State at the end of each cycle from ``START`` on; a cycle may hold any number of frames."""
    seen = []
    for n, frames in enumerate(statuses):
        now_ns = START + n * CYCLE
        for status in frames:
            watch.count(status, now_ns)
        seen.append(watch.state(now_ns))
    return seen


def test_it_starts_with_no_data_and_is_valid_after_six_frames():
    watch = new_watch()
    assert watch.state(START) is InputState.NO_DATA
    assert states(watch, [[OK]] * 6) == [InputState.INIT] * 5 + [VALID]


@pytest.mark.parametrize("bad", [[], [ERROR], [REPEATED]], ids=["lost", "broken", "repeated"])
@pytest.mark.parametrize("count", [1, 2, 10])
def test_up_to_ten_cycles_lost_or_bad_leave_it_valid(bad, count):
    assert set(states(running_watch(), [bad] * count + [[OK]] * 50)) == {VALID}


@pytest.mark.parametrize(
    ("bad", "cycles"), [([], 21), ([ERROR], 11), ([REPEATED], 20)], ids=["lost", "broken", "frozen"]
)
def test_what_does_not_end_makes_it_invalid(bad, cycles):
    seen = states(running_watch(), [bad] * 100)
    assert seen == [VALID] * (cycles - 1) + [INVALID] * (101 - cycles)


@pytest.mark.parametrize(("bad", "cycles"), [([], 10), ([ERROR], 14), ([REPEATED], 10)])
def test_it_takes_good_frames_to_be_valid_again(bad, cycles):
    seen = states(running_watch(), [bad] * 500 + [[OK]] * 20)[500:]
    assert seen == [INVALID] * (cycles - 1) + [VALID] * (21 - cycles)


def test_two_senders_make_it_invalid_though_every_frame_is_good():
    seen = states(running_watch(), [[OK, OK]] * 200)
    assert INVALID in seen[:13]
    assert set(seen[13:]) == {INVALID}


def test_a_third_more_frames_than_cycles_is_no_second_sender():
    assert set(states(running_watch(), [[OK], [OK], [OK, OK]] * 60)) == {VALID}


def test_frames_that_come_twice_for_ever_are_no_second_sender():
    assert set(states(running_watch(), [[OK, REPEATED]] * 200)) == {VALID}


def test_a_flood_of_repetitions_is_not_trusted():
    assert states(running_watch(), [[OK] + [REPEATED] * 15] * 4)[-1] is INVALID


def test_half_of_the_frames_lost_for_ever_are_bridged():
    assert set(states(running_watch(), [[OK], []] * 100)) == {VALID}


@given(
    late_ns=st.lists(st.integers(0, 2 * CYCLE), min_size=120, max_size=120),
    lost=st.sets(st.integers(0, 119), max_size=2),
    broken=st.sets(st.integers(0, 119), max_size=2),
)
def test_jitter_and_two_lost_and_two_broken_frames_leave_it_valid(late_ns, lost, broken):
    watch, arrivals, newest = running_watch(), [], 0
    for n, late in enumerate(late_ns):
        newest = max(newest, START + n * CYCLE + late)  # a bus keeps the order
        if n not in lost:
            arrivals.append((newest, ERROR if n in broken else OK))
    for n in range(120):
        now_ns = START + n * CYCLE
        while arrivals and arrivals[0][0] <= now_ns:
            stamp_ns, status = arrivals.pop(0)
            watch.count(status, stamp_ns)
        assert watch.state(now_ns) is VALID


def test_a_process_that_slept_finds_its_frames_in_the_queue_and_all_is_well():
    watch = running_watch()
    for n in range(500):
        watch.count(OK, START + n * CYCLE)
    assert watch.state(START + 500 * CYCLE) is VALID


def test_a_bench_that_starts_its_clock_anew_does_not_hide_that_nothing_comes():
    watch = running_watch()
    assert [watch.state(n * CYCLE) for n in range(40)][-1] is INVALID
