"""Lockstep: the bench's count is the only time."""

from __future__ import annotations

from runtime.fakes import PERIOD_NS, FakeBench, FakeClock, FakePort

from tcs_hil.canbus.port import Frame
from tcs_hil.runtime.lockstep import LockstepTrigger

BENCH_TICK = 0x7F0


def announcement(number: int, stamp_ns: int = 0) -> Frame:
    return Frame(BENCH_TICK, number.to_bytes(4, "little"), stamp_ns)


def lockstep(*script: Frame) -> tuple[LockstepTrigger, FakePort]:
    clock = FakeClock(123_456_789)
    port = FakePort(clock, script)
    return LockstepTrigger(clock, port, FakeBench(), BENCH_TICK, PERIOD_NS), port


def test_the_number_times_the_period_is_now() -> None:
    trigger, _ = lockstep(announcement(7))
    tick = trigger.wait()
    assert tick is not None
    assert (tick.number, tick.now_ns) == (7, 7 * PERIOD_NS)
    assert tick.wake_ns == 123_456_789


def test_inputs_carry_bench_time_whenever_they_came() -> None:
    trigger, _ = lockstep(Frame(0xA1, b"front", 5), Frame(0xA2, b"rear", 9), announcement(3))
    tick = trigger.wait()
    assert tick is not None
    now_ns = 3 * PERIOD_NS
    assert trigger.frames(tick) == [Frame(0xA1, b"front", now_ns), Frame(0xA2, b"rear", now_ns)]


def test_frames_after_the_announcement_belong_to_the_next_tick() -> None:
    trigger, _ = lockstep(announcement(1), Frame(0xA1, b"next", 0), announcement(2))
    first, second = trigger.wait(), trigger.wait()
    assert first is not None
    assert second is not None
    assert (first.number, second.number) == (1, 2)
    assert [frame.data for frame in trigger.frames(second)] == [b"next"]
    assert trigger.frames(second) == []


def test_the_answer_carries_the_number_of_the_tick() -> None:
    trigger, port = lockstep(announcement(42))
    tick = trigger.wait()
    assert tick is not None
    assert port.sent == []
    trigger.done(tick)
    assert port.sent == [(0x7F1, (42).to_bytes(4, "little"))]


def test_a_silent_bench_gives_the_caller_a_chance_to_stop() -> None:
    trigger, _ = lockstep()
    assert trigger.wait() is None


def test_inputs_spread_over_several_waits_are_kept_for_the_tick() -> None:
    first, later = Frame(0xA1, b"front", 0), Frame(0xA2, b"rear", 150_000_000)
    trigger, _ = lockstep(first, later, announcement(1, stamp_ns=150_000_000))
    assert trigger.wait() is None
    tick = trigger.wait()
    assert tick is not None
    assert [frame.data for frame in trigger.frames(tick)] == [b"front", b"rear"]


def test_a_damaged_announcement_is_passed_over() -> None:
    trigger, _ = lockstep(Frame(BENCH_TICK, b"?", 0), announcement(5))
    tick = trigger.wait()
    assert tick is not None
    assert tick.number == 5
    assert trigger.frames(tick) == []


def test_lost_announcements_are_counted_and_a_restarted_plant_is_not() -> None:
    trigger, _ = lockstep(announcement(4), announcement(7), announcement(0))
    ticks = [trigger.wait() for _ in range(3)]
    assert [tick.skipped for tick in ticks if tick is not None] == [0, 2, 0]


def test_a_bus_without_a_bench_does_not_grow_the_process() -> None:
    trigger, _ = lockstep(*(Frame(0xA1, b"", 0) for _ in range(5000)), announcement(1))
    tick = trigger.wait()
    for _ in range(9):
        tick = tick or trigger.wait()
    assert tick is not None
    assert len(trigger.frames(tick)) < 5000
