"""Recorded and replayed answers side by side."""

import math

import pytest
from factories import command
from msgspec.structs import replace

from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.frame import Frame
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.hil.replay.compare import DECISIONS, LIMITS, Comparison, Signals, compare, recorded_law
from tcs_hil.hil.replay.recorded import RecordedTick
from tcs_hil.hil.replay.story import as_dict, tell
from tcs_hil.signals import Command, TcsState, TorqueLimits

PERIOD_NS = 2_000_000
DATABASE = load_database()
GOOD = command(100.0, 120.0)


def said(*commands: Command) -> list[tuple[Frame, ...]]:
    """What a service says that decides so, tick by tick."""
    node = TcsNode(DATABASE)
    return [
        tuple(Frame(*frame, tick * PERIOD_NS) for frame in node.frames(each, tick * PERIOD_NS))
        for tick, each in enumerate(commands)
    ]


def ticks(*commands: Command) -> list[RecordedTick]:
    heard = (Frame(0x0A2, bytes(8), 0), Frame(0x7AA, b"\x01", 0))
    return [
        RecordedTick(tick, tick * PERIOD_NS, heard, answers)
        for tick, answers in enumerate(said(*commands))
    ]


def verdict(
    recorded: list[Command],
    replayed: list[Command],
    tolerance_nm: float = 0.0,
    signals: Signals = DECISIONS,
) -> Comparison:
    return compare(ticks(*recorded), said(*replayed), DATABASE, signals, tolerance_nm)


def limited(left_nm: float) -> Command:
    return replace(GOOD, limits=TorqueLimits(left_nm, 120.0))


def test_the_same_decisions_are_the_same() -> None:
    comparison = verdict([GOOD] * 12, [GOOD] * 12)
    assert comparison == Comparison(ticks=12, differing=0, largest_nm=0.0, first=())
    assert comparison.same


def test_what_is_only_displayed_may_differ() -> None:
    assert verdict([GOOD], [replace(GOOD, slip_ratio=(0.3, 0.3))]).same


def test_a_torque_limit_may_differ_by_the_tolerance_and_no_more() -> None:
    close, far = limited(100.05), limited(100.1)
    assert not verdict([GOOD], [close]).same
    assert verdict([GOOD], [close], tolerance_nm=0.05).same
    assert not verdict([GOOD], [far], tolerance_nm=0.05).same
    assert verdict([GOOD], [far], tolerance_nm=0.5).largest_nm == pytest.approx(0.1)


def test_no_limit_is_no_torque() -> None:
    unlimited = limited(math.inf)
    assert verdict([unlimited] * 2, [unlimited] * 2).same
    comparison = verdict([GOOD, GOOD], [limited(90.0), unlimited], tolerance_nm=1000.0)
    assert [(each.place, each.replayed) for each in comparison.first] == [(1, math.inf)]
    assert comparison.largest_nm == pytest.approx(10.0)
    (told,) = as_dict(ticks(GOOD, GOOD), comparison)["first"]
    assert (told["recorded"], told["replayed"]) == (100.0, "no limit")


def test_without_two_limits_there_is_no_difference_in_nm() -> None:
    recorded = [replace(GOOD, limits=TorqueLimits(100.0, 100.0))]
    assert verdict(recorded, [replace(GOOD, limits=TorqueLimits())]).largest_nm is None


def test_the_recorded_law_is_the_one_its_service_named() -> None:
    assert recorded_law(ticks(GOOD, GOOD), DATABASE) == "NMPC"
    assert recorded_law([], DATABASE) is None


def test_no_tolerance_covers_a_state() -> None:
    other = replace(GOOD, state=TcsState.DEGRADED)
    comparison = verdict([GOOD], [other], tolerance_nm=1000.0)
    assert [each.signal.name for each in comparison.first] == ["TcsState"]


def test_fault_codes_are_compared_when_the_recording_has_one() -> None:
    other = replace(GOOD, fault_code=3)
    comparison = verdict([GOOD] * 10 + [GOOD], [GOOD] * 10 + [other])
    assert [each.signal.name for each in comparison.first] == ["TcsFaultCode"]
    assert comparison.first[0].place == 10
    assert verdict([GOOD] * 3, [GOOD, other, other]).same  # between two of its frames
    assert verdict([GOOD] * 10 + [GOOD], [GOOD] * 10 + [other], signals=LIMITS).same


def test_the_first_tick_that_differs_is_told_with_all_its_signals() -> None:
    worse = replace(limited(90.0), state=TcsState.FAULT)
    comparison = verdict([GOOD] * 4, [GOOD, GOOD, worse, limited(80.0)])
    assert {each.signal.name for each in comparison.first} == {"TorqueLimitL", "TcsState"}
    assert {each.place for each in comparison.first} == {2}
    assert comparison.differing == 2
    assert comparison.largest_nm == pytest.approx(20.0)


def test_ticks_without_a_recorded_answer_are_not_compared() -> None:
    recorded = ticks(GOOD, GOOD)
    recorded[1] = recorded[1]._replace(answers=())
    comparison = compare(recorded, said(GOOD, limited(1.0)), DATABASE, DECISIONS, 0.0)
    assert comparison.same
    assert comparison.ticks == 1


def test_what_was_said_stands_until_it_is_said_otherwise() -> None:
    first, _ = said(GOOD, GOOD)
    assert compare(ticks(GOOD, GOOD), [first, ()], DATABASE, LIMITS, 0.0).same


def test_a_silent_service_differs_in_everything() -> None:
    comparison = compare(ticks(GOOD), [()], DATABASE, LIMITS, 1000.0)
    assert len(comparison.first) == 5
    assert all(math.isnan(each.replayed) for each in comparison.first)
    assert as_dict(ticks(GOOD), comparison)["first"][0]["replayed"] is None


def test_the_story_names_tick_time_signal_both_values_and_the_frames_before() -> None:
    recorded = ticks(GOOD, GOOD, GOOD)
    released = replace(GOOD, limits=TorqueLimits(), state=TcsState.FAULT)
    comparison = compare(recorded, said(GOOD, GOOD, released), DATABASE, DECISIONS, 0.0)
    lines = list(tell(recorded, comparison, DATABASE))
    assert lines[0] == "tick 2, 0.004 s: TorqueLimitL was 100, is no limit"
    assert "tick 2, 0.004 s: TcsState was ACTIVE, is FAULT" in lines
    assert lines[-2].startswith("  tick 2  0A2  WheelSpeedsRear: WheelSpeedRL=0 ")
    assert lines[-1] == "  tick 2  7AA  01"
    assert any("  tick 1  090  TorqueLimit: TorqueLimitL=100 " in line for line in lines)


def test_there_is_no_story_where_nothing_differs() -> None:
    assert not list(tell(ticks(GOOD), verdict([GOOD], [GOOD]), DATABASE))
