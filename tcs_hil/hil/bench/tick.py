"""The whole tick without the bus: the service's own loop, fed with recorded frames."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import msgspec
import numpy as np

from tcs_hil.canbus.frame import Frame, PortCounters
from tcs_hil.control.settings import ControlSettings
from tcs_hil.hil.bench.candidates import PREDICTIVE, PRESETS, backends
from tcs_hil.hil.bench.controllers import drive_of
from tcs_hil.hil.bench.effort import Effort, Progress
from tcs_hil.hil.bench.statistics import Cost, Statistics, Stopwatch, quiet_collector
from tcs_hil.runtime.clock import MonotonicClock
from tcs_hil.runtime.lockstep import FOREVER_NS
from tcs_hil.runtime.loop import Loop
from tcs_hil.runtime.recorder import FlightRecorder
from tcs_hil.runtime.recording import RunInfo, read
from tcs_hil.runtime.tick import Tick
from tcs_hil.runtime.times import Times, times_us
from tcs_hil.service.bus_end import bus_end
from tcs_hil.service.settings import ServiceConfig
from tcs_hil.service.wiring import build_laws, build_pipeline
from tcs_hil.signals import BusCondition

MANOEUVRE = "manoeuvre-1"
USABLE_SHARE = 0.5
"""Of a period; the rest is for the kernel, and for what one did not think of."""
STAGES = ("receive", "step", "solve", "send", "record")
"""``solve`` is one wheel's law and a part of ``step``; ``record`` follows what was sent."""


class TickCost(msgspec.Struct, frozen=True):
    """``whole`` is everything from the first frame to the record; stages by wall time."""

    whole: Cost
    stages: dict[str, Statistics]


class TickRow(msgspec.Struct, frozen=True):
    """The tick of the service as one preset, law and back end run it.

    ``vehicles_per_core`` such services, of two wheels each, leave half of every
    period free, even if all of them had a slow tick (p99.9 by CPU time) at once.
    """

    law: str
    preset: str
    code: str
    cost: TickCost
    vehicles_per_core: int


class _RecordedTicks:
    """A trigger that hands out recorded frames, and takes the time between its calls."""

    def __init__(self, watch: Stopwatch, ticks: Sequence[Sequence[Frame]]) -> None:
        self._watch = watch
        self._ticks = iter(ticks)
        self._frames: Sequence[Frame] = ()
        self._number = -1

    def exhausted(self) -> bool:
        """Whether every tick was replayed; ends the time of the one before."""
        if self._number >= 0:
            self._watch.stop()
        self._frames = next(self._ticks, ())
        self._number += 1
        return not self._frames

    def wait(self) -> Tick:
        """Begin the next tick; decisions are made with the time of its frames."""
        now_ns = self._frames[0].stamp_ns
        self._watch.start()
        wake_ns = time.monotonic_ns()
        return Tick(self._number, wake_ns, wake_ns, now_ns, FOREVER_NS, 0)

    def frames(self, _tick: Tick) -> Sequence[Frame]:
        """What the vehicle had sent for this tick."""
        return self._frames

    def done(self, _tick: Tick) -> None:
        """Nobody waits for this tick."""


class _DeafPort:
    """Takes what is sent, and that is all."""

    def __init__(self) -> None:
        self.counters = PortCounters()

    def receive(self) -> list[Frame]:
        """Frames come from the trigger."""
        return []

    def send(self, _frame_id: int, _data: bytes) -> bool:
        """Drop a frame."""
        return True

    def wait(self, _timeout_s: float) -> bool:
        """Nothing will come."""
        return False

    def condition(self) -> BusCondition:
        """A bus that is not there has no troubles."""
        return BusCondition.OK


def measure_ticks(effort: Effort, progress: Progress) -> list[TickRow]:
    """Replay the first manoeuvre through the service as each preset, law and back end runs it."""
    work = [(p, k.name, b) for p in PRESETS for k in PREDICTIVE for b in backends(k, p)]
    rows = []
    for done, (preset, law, backend) in enumerate(work):
        progress(done / len(work), f"tick of {law} {preset}, {backend}")
        ticks = drive_of(MANOEUVRE, law, preset).ticks[: effort.ticks]
        settings = ControlSettings(preset=preset, backend=backend)
        config = ServiceConfig(controller=law.lower(), control=settings)  # type: ignore[arg-type]
        cost = cost_of_ticks(config, ticks, effort.repeats)
        vehicles = int(USABLE_SHARE * settings.period_s * 1e6 / cost.whole.cpu.p99_9_us)
        rows.append(TickRow(law, preset, backend, cost, vehicles))
    return rows


def cost_of_ticks(
    config: ServiceConfig, ticks: Sequence[Sequence[Frame]], repeats: int
) -> TickCost:
    """Replay the ticks ``repeats`` times, each time through a fresh service."""
    watch = Stopwatch()
    passes = [_replay(config, ticks, watch) for _ in range(repeats)]
    times = {stage: np.concatenate([each[stage] for each in passes]) for stage in STAGES}
    return TickCost(watch.cost, {stage: Statistics.of(us) for stage, us in times.items()})


def _replay(config: ServiceConfig, ticks: Sequence[Sequence[Frame]], watch: Stopwatch) -> Times:
    """Times of each stage in µs."""
    clock, trigger = MonotonicClock(), _RecordedTicks(watch, ticks)
    laws = build_laws(config, clock)
    with tempfile.TemporaryDirectory(prefix="tcs-hil.") as folder, quiet_collector():
        path = Path(folder) / "flight"
        # One to spare: of a full ring the oldest tick may be half overwritten, and is not read.
        with FlightRecorder(path, _run_info(config), len(ticks) + 1) as recorder:
            loop = Loop(
                trigger=trigger,
                port=_DeafPort(),
                node=bus_end(config).node,
                pipeline=build_pipeline(config, laws),
                laws=laws,
                clock=clock,
                write=recorder.write,
                healthy=_unwatched,
            )
            loop.run(trigger.exhausted)
        times = times_us(read(path))
    return {**times, "record": watch.wall_us[-len(ticks) :] - times["total"]}


def _unwatched(_sent_ns: int) -> None:
    """No watchdog guards a replay."""


def _run_info(config: ServiceConfig) -> RunInfo:
    return RunInfo(
        period_ns=round(config.control.period_s * 1e9),
        started_monotonic_ns=0,
        started_realtime_ns=0,
        controller=config.controller,
        bus="recorded",
        machine="",
    )
