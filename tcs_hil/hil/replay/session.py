"""One replay from files to verdict."""

from __future__ import annotations

from contextlib import closing
from itertools import dropwhile
from pathlib import Path
from typing import NamedTuple

from plant_emulator.undisturbed import undisturbed
from tcs_hil.canbus.database import Database, load_database
from tcs_hil.canbus.port import open_port
from tcs_hil.hil.logs.sources import Sources
from tcs_hil.hil.replay.compare import (
    DECISIONS,
    LIMITS,
    OTHER_LAW,
    Comparison,
    compare,
    recorded_law,
)
from tcs_hil.hil.replay.in_process import replay
from tcs_hil.hil.replay.live import replay_in_lockstep, replay_in_real_time
from tcs_hil.hil.replay.load import load
from tcs_hil.hil.replay.recorded import Grid, RecordedTick
from tcs_hil.runtime.clock import MonotonicClock
from tcs_hil.service.settings import BusSettings, ServiceConfig, read_service

NS_PER_S = 1_000_000_000
SEND_TIMEOUT_S = 1.0
"""A full bus is waited for: the recording has all the time in the world."""


class OtherLaw(NamedTuple):
    """The controller recorded, and the one the replayed service ran instead."""

    recorded: str
    replayed: str


class Verdict(NamedTuple):
    """What was replayed and what came of it; ``other_law`` where another was in charge.

    ``lost`` says what could not be read of the log.
    """

    ticks: list[RecordedTick]
    grid: Grid
    database: Database
    comparison: Comparison
    lost: str
    other_law: OtherLaw | None = None


def recorded_config(sources: Sources) -> ServiceConfig:
    """The configuration kept with the run; the service's own defaults without one.

    Raises:
        ConfigError: it cannot be read.
    """
    return ServiceConfig() if sources.config is None else read_service(sources.config)


def replay_in_process(sources: Sources, config: ServiceConfig, tolerance_nm: float) -> Verdict:
    """Replay a run through a service of this process.

    Raises:
        TcsError: a file or the model cannot be used.
    """
    database, path = _database(config)
    ticks, grid, lost = load(sources, path, _period_ns(config))
    law, own = recorded_law(ticks, database), config.kind.name
    other = None if law is None or law == own else OtherLaw(law, own)
    signals = DECISIONS if other is None else OTHER_LAW
    comparison = compare(ticks, replay(ticks, config), database, signals, tolerance_nm)
    return Verdict(ticks, grid, database, comparison, lost, other)


def replay_live(sources: Sources, config: ServiceConfig, tolerance_nm: float) -> Verdict:
    """Replay a run onto the bus of ``config``, where a fresh service runs.

    In real time only the limits are compared: messages on a longer cycle come
    when the running service's cycle has it.

    Raises:
        TcsError: a file or the bus cannot be used, or the service is silent.
    """
    database, path = _database(config)
    recorded, grid, lost = load(sources, path, _period_ns(config))
    ticks = list(dropwhile(lambda tick: not tick.inputs, recorded))
    clock, signals = MonotonicClock(), DECISIONS if grid is Grid.BENCH else LIMITS
    bus: BusSettings = config.bus
    port, _ = open_port(bus.interface, bus.channel, bus.bitrate, send_timeout_s=SEND_TIMEOUT_S)
    with closing(port):
        if grid is Grid.BENCH:
            answers = replay_in_lockstep(ticks, port, clock, database)
        else:
            with undisturbed():
                answers = replay_in_real_time(ticks, port, clock, database, _period_ns(config))
    comparison = compare(ticks, answers, database, signals, tolerance_nm)
    return Verdict(ticks, grid, database, comparison, lost)


def _database(config: ServiceConfig) -> tuple[Database, Path | None]:
    path = None if config.bus.database is None else Path(config.bus.database)
    return load_database(path), path


def _period_ns(config: ServiceConfig) -> int:
    return round(config.control.period_s * NS_PER_S)
