"""Exact timing on a real vcan0: the clock moves only while everything sleeps."""

from collections import defaultdict
from collections.abc import Callable
from decimal import Decimal
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from tcs_hil.canbus.bus import open_bus
from tcs_hil.canbus.port import CanPort
from tcs_hil.hil.processes.program import program
from tcs_hil.runtime.clock import MonotonicClock
from tcs_hil.runtime.recording import read

from .conftest import CHANNEL, Candump
from .test_processes import daemon, next_limit

TICKS = 200
PERIOD_NS = 2_000_000
SETTLING_NS = 20_000_000  # the first sleep after long computing ends on the guest's 10 ms tick
WHEEL_SPEEDS_REAR = 0x0A2
PROMPT_NS = 50_000  # a tick without its frame wakes 1 ms after it was due
ROUNDING_US = 1  # candump writes whole microseconds

pytestmark = pytest.mark.simulated_time


def test_frames_sent_on_the_grid_are_one_period_apart(candump: Callable[[int], Candump]) -> None:
    port, clock, dump = CanPort(open_bus("auto", CHANNEL)[0]), MonotonicClock(), candump(TICKS)
    start_ns = clock.now_ns() + SETTLING_NS
    for tick in range(TICKS):
        clock.sleep_until(start_ns + tick * PERIOD_NS)
        assert port.send(0x123, tick.to_bytes(2, "big"))
    port.close()

    stamps_us = [Decimal(line.split()[0].strip("()")) * 1_000_000 for line in dump.lines()]
    gaps_us = [float(later - earlier) for earlier, later in pairwise(stamps_us)]
    assert gaps_us == pytest.approx([PERIOD_NS / 1000] * (TICKS - 1), abs=ROUNDING_US)


def test_a_service_that_ticks_with_the_wheel_speeds_wakes_when_they_come(tmp_path: Path) -> None:
    flight, clock = tmp_path / "flight", MonotonicClock()
    bus, _ = open_bus("auto", CHANNEL)
    with bus, daemon(tmp_path, "--trigger", "frame", "--flight-recording", str(flight)):
        next_limit(bus)
        port = CanPort(open_bus("auto", CHANNEL)[0])
        start_ns = clock.now_ns() + SETTLING_NS
        for tick in range(TICKS):
            clock.sleep_until(start_ns + tick * PERIOD_NS)
            assert port.send(WHEEL_SPEEDS_REAR, bytes(8))
        port.close()
    ticks = read(flight)
    met = ticks[ticks["frames"] > 0]
    # The first may come just after a tick that was made without it, and be nobody's start.
    assert len(met) >= TICKS - 1
    assert np.median(met["wake_ns"] - met["scheduled_ns"]) < PROMPT_NS


@pytest.mark.parametrize("car", ["quarter-car", "vehicle"])
def test_the_emulator_alone_sends_every_message_on_its_cycle(
    tmp_path: Path, candump: Callable[[int], Candump], car: str
) -> None:
    dump = candump(1000)
    arguments = ("plant_emulator", "run", "--scenario", "manoeuvre-1", "--vehicle", car)
    with program(*arguments, "--channel", CHANNEL, log=tmp_path / "plant.log"):
        lines = dump.lines()
    stamps_ms: dict[str, list[float]] = defaultdict(list)
    for line in lines:
        stamp, _, frame = line.split()
        stamps_ms[frame.partition("#")[0]].append(float(Decimal(stamp.strip("()")) * 1000))
    assert set(stamps_ms) == {"098", "0A0", "0A1", "0A2"}
    for frame_id, cycle_ms in (("098", 10.0), ("0A0", 2.0), ("0A1", 2.0), ("0A2", 2.0)):
        gaps_ms = [later - earlier for earlier, later in pairwise(stamps_ms[frame_id])]
        # On the whole car's emulated wire a cycle's frames wait for each other, up to one frame.
        assert gaps_ms == pytest.approx([cycle_ms] * len(gaps_ms), abs=0.3)
        assert sum(gaps_ms) / len(gaps_ms) == pytest.approx(cycle_ms, abs=0.01)
