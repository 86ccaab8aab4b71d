"""A recorded run read for replay: the ticks of its service."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import can

from tcs_hil.canbus.database import load_database, parse_dbc
from tcs_hil.canbus.frame import Frame
from tcs_hil.errors import ConfigError
from tcs_hil.hil.logs.bench_clock import bench_ticks
from tcs_hil.hil.logs.bus_log import salvage_log, stamp_ns
from tcs_hil.hil.logs.sources import Sources
from tcs_hil.hil.replay.grids import at_recorded_ticks, at_the_limits, on_the_bench, part
from tcs_hil.hil.replay.recorded import Grid, RecordedTick, Recording
from tcs_hil.runtime.recording import read, read_info


def load(sources: Sources, dbc: Path | None, period_ns: int) -> Recording:
    """Find the ticks of the recorded service, in the most exact way the sources allow.

    Of a damaged log those before the damage are found.

    Raises:
        TcsError: there is no log, it cannot be read, or nobody answers anybody in it.
    """
    if sources.bus is None:
        raise ConfigError("a replay needs the bus log of the run")
    log, lost = salvage_log(sources.bus)
    ticks, grid = _find_ticks(log, sources.flight, dbc, period_ns)
    recording = Recording(list(ticks), grid, lost)
    heard = any(tick.inputs for tick in recording.ticks)
    if not (heard and any(tick.answers for tick in recording.ticks)):
        raise ConfigError(f"{sources.bus}: holds no vehicle and service that speak to each other")
    return recording


def _find_ticks(
    log: list[can.Message], flight: Path | None, dbc: Path | None, period_ns: int
) -> tuple[Iterable[RecordedTick], Grid]:
    database = load_database(dbc)
    # The service takes nothing but classic frames with 11-bit identifiers.
    messages = [m for m in log if not (m.is_extended_id or m.is_fd)]
    frames = list(map(_frame, messages))
    numbers = bench_ticks(messages, parse_dbc(dbc)[1])
    if numbers is not None:
        return on_the_bench(frames, numbers.tolist(), database, period_ns), Grid.BENCH
    parted = part(frames, database)
    if flight is not None:
        return at_recorded_ticks(parted, read(flight), read_info(flight)), Grid.FLIGHT
    limit_id = database.messages["TorqueLimit"].frame_id
    return at_the_limits(parted, limit_id), Grid.LIMITS


def _frame(message: can.Message) -> Frame:
    return Frame(message.arbitration_id, bytes(message.data), stamp_ns(message))
