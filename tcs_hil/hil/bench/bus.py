"""The service on a bus in real time, and in its place a process that only wakes.

Both run beside the same plant and bus recorder, with the same rights and on the
same grid, so what differs between their wakes is the service itself.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import msgspec
import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from plant_emulator.scenario import Scenario, load_scenario
from tcs_hil.canbus.bus import choose_interface
from tcs_hil.hil.bench.effort import Effort, Progress
from tcs_hil.hil.bench.statistics import Statistics
from tcs_hil.hil.processes.program import program, spawned
from tcs_hil.hil.run import SERVICE_PHASE_US, RunPlan, execute
from tcs_hil.hil.toml import write_toml
from tcs_hil.runtime.clock import MonotonicClock
from tcs_hil.runtime.doctor.baseline import PERIOD_NS, wake_jitter_us
from tcs_hil.runtime.realtime import Grant, prepare
from tcs_hil.runtime.times import times_us
from tcs_hil.service.settings import BusSettings, ServiceConfig

SCENARIO = "launch-mu-008"
"""Ice: the law has to hold the wheels for as long as one likes."""
PLANT_SPARE_S = 10.0
"""The plant drives on until whoever only wakes has started and finished."""


class BusRow(msgspec.Struct, frozen=True):
    """One run; ``late`` ticks were sent after their deadline, ``skipped`` ones never made.

    ``baseline`` is the wake jitter without the service.
    """

    law: str
    bus: str
    without: list[str]
    ticks: int
    late: int
    skipped: int
    lost_frames: int
    baseline: Statistics
    jitter: Statistics
    tick: Statistics
    latency: Statistics

    @property
    def jitter_ratio(self) -> float:
        """The service's p99.9 wake jitter over that of the baseline."""
        return self.jitter.p99_9_us / self.baseline.p99_9_us


def measure_bus(effort: Effort, progress: Progress) -> list[BusRow]:
    """Run the default Koopman MPC on ``vcan0``, or on the embedded bus where there is none."""
    config = ServiceConfig(bus=_bus())
    launch = load_scenario(SCENARIO)
    with tempfile.TemporaryDirectory(prefix="tcs-hil.") as folder:
        progress(0.0, f"wakes without the service, {effort.bus_s:g} s")
        longer = replace(launch, duration_s=effort.bus_s + PLANT_SPARE_S, expect=())
        baseline, grants = _baseline(longer, config.bus, Path(folder), effort.bus_s)
        progress(0.5, f"service on a bus, {effort.bus_s:g} s")
        scenario = replace(launch, duration_s=effort.bus_s, expect=())
        files = execute(RunPlan(scenario, config, "real-time", Path(folder) / "run"))
        return [_row(config, files.read_flight(), baseline, grants)]


def _bus() -> BusSettings:
    """A channel of our own on the embedded bus must not meet anybody's."""
    interface, _ = choose_interface("auto", "vcan0")
    return BusSettings(channel="vcan0" if interface == "socketcan" else f"vcan-{os.getpid()}")


def _baseline(
    scenario: Scenario, bus: BusSettings, folder: Path, seconds: float
) -> tuple[NDArray[np.float64], list[Grant]]:
    """Wake jitter in µs (n,) beside the plant and the recorder, and what the wakes were granted."""
    path = folder / "scenario.toml"
    write_toml(path, scenario.resolved())
    where = ("--interface", bus.interface, "--channel", bus.channel)
    plant = ("plant_emulator", "run", "--scenario", str(path), "--mode", "realtime", *where)
    with (
        program("tcs_hil", "record", str(folder / "bus.blf"), *where, log=folder / "recorder.log"),
        program(*plant, log=folder / "plant.log"),
        spawned(1) as pool,
    ):
        return pool.apply(_idle, (round(seconds * 1e9 / PERIOD_NS),))


def _idle(wakes: int) -> tuple[NDArray[np.float64], list[Grant]]:
    """Wake as the service does, and do nothing."""
    grants = prepare()
    phase_ns = SERVICE_PHASE_US * 1000
    return wake_jitter_us(MonotonicClock(), wakes, phase_ns=phase_ns), grants


def _row(
    config: ServiceConfig,
    ticks: NDArray[np.void],
    baseline_us: NDArray[np.float64],
    grants: list[Grant],
) -> BusRow:
    times = times_us(ticks)
    return BusRow(
        law=config.kind.name,
        bus=choose_interface(config.bus.interface, config.bus.channel)[0],
        without=[grant.what for grant in grants if not grant.got],
        ticks=len(ticks),
        late=int(ticks["overrun"].sum()),
        skipped=int(ticks["skipped"].sum()),
        lost_frames=int(ticks["lost_frames"][-1]),
        baseline=Statistics.of(baseline_us),
        jitter=Statistics.of(times["wake_jitter"]),
        tick=Statistics.of(times["total"]),
        latency=Statistics.of(times["latency"]),
    )
