"""Stamps of the wall clock, moved to the monotonic clock even when it steps."""

from __future__ import annotations

import time

import can
import pytest

from tcs_hil.canbus.stamps import RealtimeStamps

FLOAT_NS = 1_000  # seconds since 1970 as a float resolve some 250 ns


def stamped(seconds_ago):
    return can.Message(timestamp=time.time() - seconds_ago)


def test_a_wall_clock_stamp_keeps_its_distance_to_now():
    stamps = RealtimeStamps()
    message, now_ns = stamped(0.5), time.monotonic_ns()
    stamps.begin()
    # Between the two clocks of the line above the test may be descheduled.
    assert stamps.stamp_ns(message) == pytest.approx(now_ns - 500_000_000, abs=5_000_000)


@pytest.mark.parametrize("step_s", [-3600.0, 3600.0])
def test_a_step_of_the_wall_clock_cannot_move_a_frame_out_of_its_tick(step_s):
    stamps = RealtimeStamps()
    previous_ns = time.monotonic_ns()
    stamps.begin()
    stamps.end()
    stamps.begin()
    assert previous_ns <= stamps.stamp_ns(stamped(step_s)) <= time.monotonic_ns()


def test_frames_left_over_from_a_cut_off_drain_may_be_older_than_it():
    stamps = RealtimeStamps()
    stamps.begin()
    message = stamped(0.25)
    stamps.begin()
    assert stamps.stamp_ns(message) < time.monotonic_ns() - 250_000_000 + FLOAT_NS
