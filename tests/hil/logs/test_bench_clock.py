"""To which tick of the bench each frame of a log belongs."""

import can
import numpy as np
import pytest

from tcs_hil.canbus.database import parse_dbc
from tcs_hil.errors import ConfigError
from tcs_hil.hil.logs.bench_clock import bench_ticks

DBC = parse_dbc()[1]
REAR, LIMIT, TICK, DONE, STRANGER = 0x0A2, 0x090, 0x7F0, 0x7F1, 0x123


def log(*frames: tuple[int, int]) -> list[can.Message]:
    """Frames as (identifier, tick number where it carries one)."""
    return [
        can.Message(arbitration_id=frame_id, data=number.to_bytes(4, "little"))
        for frame_id, number in frames
    ]


def test_frames_belong_to_the_tick_that_their_sender_closes_next() -> None:
    ticks = bench_ticks(
        log((REAR, 0), (TICK, 7), (LIMIT, 0), (DONE, 7), (REAR, 0), (TICK, 8), (LIMIT, 0)), DBC
    )
    np.testing.assert_array_equal(ticks, [7, 7, 7, 7, 8, 8, 8])


def test_answers_that_the_log_holds_late_keep_their_tick() -> None:
    ticks = bench_ticks(
        log((REAR, 0), (TICK, 0), (REAR, 0), (TICK, 1), (LIMIT, 0), (DONE, 0), (DONE, 1)), DBC
    )
    np.testing.assert_array_equal(ticks, [0, 0, 1, 1, 0, 0, 1])


def test_strangers_are_heard_with_the_vehicle() -> None:
    ticks = bench_ticks(log((TICK, 0), (LIMIT, 0), (STRANGER, 0), (DONE, 0), (TICK, 1)), DBC)
    np.testing.assert_array_equal(ticks, [0, 0, 1, 0, 1])


def test_a_service_that_never_answered_is_no_obstacle() -> None:
    np.testing.assert_array_equal(bench_ticks(log((TICK, 5), (TICK, 6)), DBC), [5, 6])


def test_a_log_without_a_bench_has_no_ticks() -> None:
    assert bench_ticks(log((REAR, 0), (LIMIT, 0)), DBC) is None


def test_two_runs_in_one_log_are_refused() -> None:
    with pytest.raises(ConfigError, match="more than one run"):
        bench_ticks(log((TICK, 3), (TICK, 0)), DBC)
