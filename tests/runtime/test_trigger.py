"""The grid of the timer: absolute, aligned, never in a burst."""

from __future__ import annotations

import pytest
from runtime.fakes import PERIOD_NS, FakeClock, FakePort

from tcs_hil.canbus.port import Frame
from tcs_hil.runtime.trigger import Grid, TimerTrigger

START_NS = 7_300_000


@pytest.fixture
def clock() -> FakeClock:
    return FakeClock(START_NS)


@pytest.fixture
def timer(clock: FakeClock) -> TimerTrigger:
    return TimerTrigger(clock, FakePort(clock), PERIOD_NS, phase_ns=500_000)


def test_ticks_fall_on_multiples_of_the_period_plus_the_phase(timer: TimerTrigger) -> None:
    ticks = [timer.wait() for _ in range(4)]
    assert [tick.scheduled_ns for tick in ticks] == [8_500_000, 10_500_000, 12_500_000, 14_500_000]
    assert [tick.number for tick in ticks] == [0, 1, 2, 3]
    assert not any(tick.skipped for tick in ticks)


@pytest.mark.parametrize("phase_ns", [-PERIOD_NS, 0, 1, PERIOD_NS - 1, 3 * PERIOD_NS + 5])
def test_any_phase_gives_a_first_point_within_one_period(phase_ns: int) -> None:
    point_ns, skipped = Grid(START_NS, PERIOD_NS, phase_ns).next_after(START_NS)
    assert 0 < point_ns - START_NS <= PERIOD_NS
    assert (point_ns - phase_ns) % PERIOD_NS == 0
    assert skipped == 0


def test_work_within_the_period_does_not_move_the_grid(
    clock: FakeClock, timer: TimerTrigger
) -> None:
    first = timer.wait()
    clock.work(PERIOD_NS - 1)
    assert timer.wait().scheduled_ns == first.scheduled_ns + PERIOD_NS


def test_an_overrun_skips_to_the_grid_and_counts_what_it_missed(
    clock: FakeClock, timer: TimerTrigger
) -> None:
    first = timer.wait()
    clock.work(2 * PERIOD_NS + 1)
    late = timer.wait()
    assert late.scheduled_ns == first.scheduled_ns + 3 * PERIOD_NS
    assert (late.skipped, late.number) == (2, 3)


def test_after_an_overrun_there_is_no_burst(clock: FakeClock, timer: TimerTrigger) -> None:
    timer.wait()
    clock.work(10 * PERIOD_NS)
    late, following = timer.wait(), timer.wait()
    assert following.scheduled_ns - late.scheduled_ns == PERIOD_NS
    assert following.skipped == 0


def test_a_late_wake_is_seen_as_jitter_and_the_deadline_stays(clock: FakeClock) -> None:
    timer = TimerTrigger(clock, FakePort(clock), PERIOD_NS)
    on_time = clock.sleep_until
    clock.sleep_until = lambda deadline_ns: on_time(deadline_ns + 70_000)  # type: ignore[method-assign]
    tick = timer.wait()
    assert tick.wake_ns - tick.scheduled_ns == 70_000
    assert tick.now_ns == tick.wake_ns
    assert tick.deadline_ns == tick.scheduled_ns + PERIOD_NS


def test_time_spent_before_the_first_tick_skips_nothing(
    clock: FakeClock, timer: TimerTrigger
) -> None:
    clock.work(50 * PERIOD_NS)
    tick = timer.wait()
    assert (tick.number, tick.skipped) == (0, 0)


def test_the_timer_drains_the_bus_after_waking(clock: FakeClock) -> None:
    early, late = Frame(1, b"", START_NS), Frame(2, b"", START_NS + PERIOD_NS)
    timer = TimerTrigger(clock, FakePort(clock, [early, late]), PERIOD_NS)
    assert timer.frames(timer.wait()) == [early]
    assert timer.frames(timer.wait()) == [late]
