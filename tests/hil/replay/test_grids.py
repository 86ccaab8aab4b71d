"""Finding the ticks of a recorded service."""

from collections.abc import Iterable

import numpy as np
import pytest
from msgspec.structs import replace
from runtime.fakes import RUN

from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.frame import Frame
from tcs_hil.hil.replay.grids import at_recorded_ticks, at_the_limits, on_the_bench, part
from tcs_hil.hil.replay.recorded import RecordedTick
from tcs_hil.signals import BusCondition

DATABASE = load_database()
REAR, LIMIT, STATUS, TICK, DONE = 0x0A2, 0x090, 0x300, 0x7F0, 0x7F1
PERIOD_NS = 2_000_000
WAKE_NS, RECEIVED_NS, SENT_NS = 500_000, 520_000, 600_000  # after the plant's instant
CLOCKS_NS = 1_000_000_000  # the calendar is ahead of the monotonic clock
CLOCKS = replace(RUN, started_monotonic_ns=0, started_realtime_ns=CLOCKS_NS)

TICK_DTYPE = np.dtype(
    [
        *((name, "<i8") for name in ("number", "now_ns", "wake_ns", "received_ns", "frames")),
        ("bus_condition", "|u1"),
    ]
)


def frame(frame_id: int, stamp_ns: int, data: bytes = b"") -> Frame:
    return Frame(frame_id, data, stamp_ns)


def ids(frames: Iterable[Frame]) -> list[int]:
    return [each.frame_id for each in frames]


def flight(counts: list[int]) -> np.ndarray:
    """Ticks that took as many frames each."""
    ticks = np.zeros(len(counts), TICK_DTYPE)
    ticks["number"] = np.arange(len(counts))
    ticks["wake_ns"] = ticks["now_ns"] = ticks["number"] * PERIOD_NS + WAKE_NS
    ticks["received_ns"] = ticks["number"] * PERIOD_NS + RECEIVED_NS
    ticks["frames"] = counts
    return ticks


def recorded(inputs_ns: list[int], answers_ns: list[int], ticks: np.ndarray) -> list[RecordedTick]:
    """The ticks of a log whose inputs carry their place as data."""
    log = [frame(REAR, CLOCKS_NS + at, n.to_bytes(2, "little")) for n, at in enumerate(inputs_ns)]
    log += [frame(LIMIT, CLOCKS_NS + at) for at in answers_ns]
    return list(at_recorded_ticks(part(log, DATABASE), ticks, CLOCKS))


def places(tick: RecordedTick) -> list[int]:
    return [int.from_bytes(each.data, "little") for each in tick.inputs]


def test_on_the_bench_inputs_and_answers_carry_the_time_of_their_tick() -> None:
    log = [frame(each, 9) for each in (REAR, TICK, LIMIT, DONE, REAR, TICK, LIMIT, DONE)]
    first, second = on_the_bench(log, [4, 4, 4, 4, 5, 5, 5, 5], DATABASE, PERIOD_NS)
    assert (first.number, first.now_ns) == (4, 4 * PERIOD_NS)
    assert (ids(first.inputs), ids(first.answers)) == ([REAR, TICK], [LIMIT, DONE])
    assert {each.stamp_ns for each in second.inputs} == {5 * PERIOD_NS}


def test_a_tick_the_bench_never_announced_was_never_made() -> None:
    log = [frame(each, 9) for each in (TICK, LIMIT, REAR)]
    (only,) = on_the_bench(log, [0, 0, 1], DATABASE, PERIOD_NS)
    assert only.number == 0


def test_a_flight_recording_says_when_and_how_many() -> None:
    inputs_ns = [0, 100, PERIOD_NS, PERIOD_NS + 100]
    first, second = recorded(inputs_ns, [SENT_NS, PERIOD_NS + SENT_NS], flight([2, 2]))
    assert (places(first), places(second)) == ([0, 1], [2, 3])
    assert second.now_ns == PERIOD_NS + WAKE_NS
    assert [each.stamp_ns for each in second.inputs] == inputs_ns[2:]  # the service's own clock
    assert [len(tick.answers) for tick in (first, second)] == [1, 1]


def test_a_frame_that_came_just_after_the_drain_is_the_next_tick_s() -> None:
    first, second = recorded([0, RECEIVED_NS - 10], [SENT_NS], flight([1, 1]))
    assert (places(first), places(second)) == ([0], [1])


def test_a_frame_the_log_stamps_late_is_still_its_tick_s() -> None:
    (only,) = recorded([RECEIVED_NS + 50_000], [SENT_NS], flight([1]))
    assert places(only) == [0]


def test_what_had_come_before_the_service_listened_was_not_heard() -> None:
    (only,) = recorded([-3_000, -2_000, 0], [SENT_NS], flight([1]))
    assert places(only) == [2]


def test_a_backlog_that_took_several_drains_was_heard_in_full() -> None:
    first, second, *_ = recorded([0] * 300, [SENT_NS], flight([256, 44, 0, 0]))
    assert (len(first.inputs), len(second.inputs)) == (256, 44)


def test_a_tick_that_heard_nothing_stays_deaf() -> None:
    first, second = recorded([0, PERIOD_NS], [SENT_NS], flight([1, 0]))
    assert (places(first), places(second)) == ([0], [])


def test_a_frame_the_log_lost_is_not_made_up_for_with_a_later_one() -> None:
    first, second = recorded([0, PERIOD_NS], [SENT_NS], flight([2, 1]))
    assert (places(first), places(second)) == ([0], [1])


def test_the_trouble_the_bus_had_is_replayed_too() -> None:
    ticks = flight([1, 1])
    ticks["bus_condition"][1] = BusCondition.BUS_OFF
    first, second = recorded([0, PERIOD_NS], [SENT_NS], ticks)
    assert (first.bus, second.bus) == (BusCondition.OK, BusCondition.BUS_OFF)


def test_an_older_flight_recording_says_nothing_against_the_bus() -> None:
    names = [name for name in TICK_DTYPE.names or () if name != "bus_condition"]
    (only,) = recorded([0], [SENT_NS], flight([1])[names])
    assert only.bus is BusCondition.OK


def test_answers_from_before_the_ring_s_oldest_tick_are_nobody_s() -> None:
    (only,) = recorded([0], [-PERIOD_NS + SENT_NS, SENT_NS], flight([1]))
    assert len(only.answers) == 1


def test_without_either_each_torque_limit_ends_a_tick() -> None:
    log = [frame(REAR, 1), frame(STATUS, 2), frame(LIMIT, 3), frame(REAR, 4), frame(LIMIT, 5)]
    first, second = at_the_limits(part(log, DATABASE), LIMIT)
    assert (first.number, first.now_ns, second.number, second.now_ns) == (0, 3, 1, 5)
    assert (ids(first.inputs), ids(first.answers)) == ([REAR], [STATUS, LIMIT])
    assert (ids(second.inputs), ids(second.answers)) == ([REAR], [LIMIT])


@pytest.mark.parametrize(
    "log", [[frame(LIMIT, 2), frame(REAR, 1)], [frame(REAR, 1), frame(LIMIT, 2)]]
)
def test_a_log_out_of_order_is_put_in_order(log: list[Frame]) -> None:
    (only,) = at_the_limits(part(log, DATABASE), LIMIT)
    assert ids(only.inputs) == [REAR]
