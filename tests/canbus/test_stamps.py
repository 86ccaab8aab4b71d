"""Stamps of the wall clock, moved to the monotonic clock even when it steps."""

from __future__ import annotations

import time

import pytest

from tcs_hil.canbus.stamps import RealtimeStamps

S = 1_000_000_000


def test_a_wall_clock_stamp_keeps_its_distance_to_now():
    stamps = RealtimeStamps()
    half_a_second_ago_ns, now_ns = time.time_ns() - S // 2, time.monotonic_ns()
    stamps.begin()
    # Between the two clocks of the line above the test may be descheduled.
    assert stamps.moved_ns(half_a_second_ago_ns) == pytest.approx(now_ns - S // 2, abs=5_000_000)


@pytest.mark.parametrize("step_ns", [-3600 * S, 3600 * S])
def test_a_step_of_the_wall_clock_cannot_move_a_frame_out_of_its_tick(step_ns):
    stamps = RealtimeStamps()
    previous_ns = time.monotonic_ns()
    stamps.begin()
    stamps.end()
    stamps.begin()
    assert previous_ns <= stamps.moved_ns(time.time_ns() - step_ns) <= time.monotonic_ns()


def test_frames_left_over_from_a_cut_off_drain_may_be_older_than_it():
    stamps = RealtimeStamps()
    stamps.begin()
    stamp_ns = time.time_ns() - S // 4
    stamps.begin()
    assert stamps.moved_ns(stamp_ns) < time.monotonic_ns() - S // 4 + 1_000
