"""Ticks with a frame: in step with it, and without it when it stays away."""

from __future__ import annotations

import pytest
from runtime.fakes import PERIOD_NS, FakeClock, FakePort

from tcs_hil.canbus.port import Frame
from tcs_hil.runtime.frame_trigger import FrameTrigger
from tcs_hil.runtime.tick import Tick

REAR = 0xA2
DRIVER = 0x98


def ticks(count: int, *script: Frame) -> list[Tick]:
    clock = FakeClock()
    trigger = FrameTrigger(clock, FakePort(clock, script), REAR, PERIOD_NS)
    return [trigger.wait() for _ in range(count)]


def rear(periods: float) -> Frame:
    return Frame(REAR, b"rear", round(periods * PERIOD_NS))


def in_periods(ticks: list[Tick]) -> list[float]:
    return [tick.wake_ns / PERIOD_NS for tick in ticks]


def test_every_frame_starts_a_tick_at_once() -> None:
    made = ticks(3, rear(1.0), rear(2.1), rear(3.0))
    assert in_periods(made) == [1.0, 2.1, 3.0]
    assert [tick.number for tick in made] == [0, 1, 2]
    assert all(tick.scheduled_ns == tick.wake_ns for tick in made)


def test_other_frames_start_no_tick_and_are_inputs_of_the_next() -> None:
    clock = FakeClock()
    script = [Frame(DRIVER, b"driver", PERIOD_NS // 2), rear(1.0)]
    trigger = FrameTrigger(clock, FakePort(clock, script), REAR, PERIOD_NS)
    tick = trigger.wait()
    assert [frame.data for frame in trigger.frames(tick)] == [b"driver", b"rear"]
    assert trigger.frames(tick) == []


def test_a_lost_frame_is_given_half_a_period() -> None:
    assert in_periods(ticks(3, rear(1.0), rear(3.0))) == [1.0, 2.5, 3.0]


def test_a_silent_bus_ticks_every_period_on_the_schedule_of_the_last_frame() -> None:
    made = ticks(4, rear(1.0))
    assert in_periods(made) == [1.0, 2.5, 3.5, 4.5]
    assert [tick.scheduled_ns // PERIOD_NS for tick in made] == [1, 2, 3, 4]


def test_a_frame_that_comes_just_after_it_was_given_up_starts_no_second_tick() -> None:
    assert in_periods(ticks(3, rear(1.0), rear(2.6), rear(3.0))) == [1.0, 2.5, 3.0]


def test_frames_that_come_just_too_late_are_caught_up_with() -> None:
    made = ticks(4, rear(1.6), rear(2.6), rear(3.6), rear(4.6))
    assert in_periods(made) == [1.5, 2.6, 3.6, 4.6]
    assert [(tick.number, tick.skipped) for tick in made] == [(0, 0), (1, 0), (2, 0), (3, 0)]


def test_after_a_stall_one_tick_serves_all_frames_and_counts_the_others() -> None:
    clock = FakeClock()
    port = FakePort(clock, [rear(n) for n in range(1, 6)])
    trigger = FrameTrigger(clock, port, REAR, PERIOD_NS)
    trigger.wait()
    clock.work(4 * PERIOD_NS)
    tick = trigger.wait()
    assert (tick.number, tick.skipped) == (4, 3)
    assert len(trigger.frames(tick)) == 5


def test_after_a_stall_on_a_silent_bus_the_missed_ticks_are_counted() -> None:
    clock = FakeClock()
    trigger = FrameTrigger(clock, FakePort(clock, [rear(1.0)]), REAR, PERIOD_NS)
    trigger.wait()
    clock.work(5 * PERIOD_NS + PERIOD_NS // 2)
    late, following = trigger.wait(), trigger.wait()
    assert (late.skipped, late.scheduled_ns) == (4, 6 * PERIOD_NS)
    assert following.wake_ns - late.wake_ns == PERIOD_NS


def test_time_before_the_first_wait_is_nobodys_tick() -> None:
    clock = FakeClock()
    trigger = FrameTrigger(clock, FakePort(clock), REAR, PERIOD_NS)
    clock.work(5 * PERIOD_NS)
    first = trigger.wait()
    assert (first.skipped, first.number, first.wake_ns) == (0, 0, 6.5 * PERIOD_NS)


class BabblingPort(FakePort):
    """A bus on which another node never stops talking."""

    patience = 100

    def wait(self, timeout_s: float) -> bool:
        self.patience -= 1
        if not self.patience:
            pytest.fail("the babble stopped the tick")
        self._clock.work(min(round(timeout_s * 1e9), PERIOD_NS // 10))
        return True

    def receive(self) -> list[Frame]:
        return [Frame(DRIVER, b"babble", self._clock.now_ns())]


def test_a_babbling_node_does_not_stop_the_ticks() -> None:
    clock = FakeClock()
    trigger = FrameTrigger(clock, BabblingPort(clock), REAR, PERIOD_NS)
    assert in_periods([trigger.wait(), trigger.wait()]) == [1.5, 2.5]
