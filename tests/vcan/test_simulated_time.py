"""Exact timing on a real vcan0: the clock moves only while everything sleeps, so nothing is late."""

from collections.abc import Callable
from decimal import Decimal

import pytest

from tcs_hil.canbus.bus import open_bus
from tcs_hil.canbus.port import CanPort
from tcs_hil.runtime.clock import MonotonicClock

from .conftest import CHANNEL, Candump

PERIOD_NS = 2_000_000
ROUNDING_US = 1  # candump writes whole microseconds

pytestmark = pytest.mark.simulated_time


def test_frames_sent_on_the_grid_are_one_period_apart(candump: Callable[[int], Candump]) -> None:
    port, clock, dump = CanPort(open_bus("auto", CHANNEL)[0]), MonotonicClock(), candump(200)
    start_ns = clock.now_ns()
    for tick in range(200):
        clock.sleep_until(start_ns + tick * PERIOD_NS)
        assert port.send(0x123, tick.to_bytes(2, "big"))
    port.close()

    stamps_us = [int(Decimal(line.split()[0][1:-1]) * 1_000_000) for line in dump.lines()]
    gaps_us = [
        later - earlier for earlier, later in zip(stamps_us[1:], stamps_us[2:], strict=False)
    ]
    assert gaps_us == pytest.approx([PERIOD_NS / 1000] * 198, abs=ROUNDING_US)
