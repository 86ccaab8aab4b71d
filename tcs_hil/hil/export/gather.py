"""Read what a run left and put it on one time base."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator
from pathlib import Path

import can
import numpy as np
from cantools.database.can import Database as CanDatabase
from numpy.typing import NDArray

from tcs_hil.canbus.database import parse_dbc
from tcs_hil.errors import ConfigError
from tcs_hil.hil.export.decode import message_tables
from tcs_hil.hil.export.table import NS_PER_S, Run, Table
from tcs_hil.hil.export.telemetry import telemetry_table
from tcs_hil.hil.export.time_base import Parts, TimeBase, align
from tcs_hil.hil.export.truth import truth_table
from tcs_hil.hil.logs.bus_log import Salvage, salvage_log
from tcs_hil.hil.logs.sources import Sources
from tcs_hil.runtime.recording import read, read_info

NO_JITTER = np.empty(0, np.int64)


def gather(sources: Sources, dbc_path: Path | None = None) -> Run:
    """Read, align and decode a run; ``dbc_path`` replaces the DBC of this project.

    A damaged log counts as far as it can be read; ``lost`` says so.

    Raises:
        TcsError: a file cannot be read, or its time is not known.
    """
    _, dbc = parse_dbc(dbc_path)
    log = Salvage([]) if sources.bus is None else salvage_log(sources.bus)
    parts, scenario = _read(sources, log.frames)
    base = align(parts, dbc)
    frames = [parts.frames[place] for place in base.order]
    tables = tuple(_tables(parts, frames, base, dbc))
    about = _about(parts, scenario)
    return Run(base.start_ns, tables, _stamped(frames, base), about, log.lost)


def _read(sources: Sources, frames: list[can.Message]) -> tuple[Parts, str]:
    ticks = None if sources.flight is None else read(sources.flight)
    info = None if sources.flight is None else read_info(sources.flight)
    if sources.truth is None:
        return Parts(frames, ticks, info, None, NO_JITTER), ""
    truth, jitter_ns, scenario = _read_truth(sources.truth)
    return Parts(frames, ticks, info, truth, jitter_ns), scenario


def _read_truth(path: Path) -> tuple[NDArray[np.void], NDArray[np.int64], str]:
    try:
        with path.open("rb") as file, np.load(file) as recording:
            return recording["truth"], recording["jitter_ns"], str(recording["scenario"])
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read ({error.strerror})") from error
    except (ValueError, KeyError, zipfile.BadZipFile) as error:
        # What numpy says to that is how to trust a file with any code in it.
        raise ConfigError(f"{path}: no truth of the plant, as the emulator records it") from error


def _tables(
    parts: Parts, frames: list[can.Message], base: TimeBase, dbc: CanDatabase
) -> Iterator[Table]:
    yield from message_tables(frames, base.frames_ns, dbc)
    if parts.ticks is not None:
        yield telemetry_table(parts.ticks, base.ticks_ns)
    if parts.truth is not None:
        yield truth_table(parts.truth, base.truth_ns)


def _stamped(frames: list[can.Message], base: TimeBase) -> tuple[can.Message, ...]:
    for frame, time_s in zip(frames, (base.frames_ns / NS_PER_S).tolist(), strict=True):
        frame.timestamp = time_s
    return tuple(frames)


def _about(parts: Parts, scenario: str) -> dict[str, str]:
    about = (
        {}
        if parts.info is None
        else {
            "controller": parts.info.controller,
            "bus": parts.info.bus,
            "machine": parts.info.machine,
        }
    )
    return about | ({"scenario": scenario} if scenario else {})
