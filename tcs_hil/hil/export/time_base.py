"""One time base for log, telemetry and truth of a run.

In lockstep it is the bench's clock: tick number times the period.  In real time
it is the calendar clock that bus logs carry, from the earliest record on: the
flight recording was started at a known time of both clocks, and the truth began
when the plant woke for its first instant, just before its first frame.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import can
import numpy as np
from cantools.database.can import Database as CanDatabase
from numpy.typing import NDArray

from tcs_hil.canbus.contract import VEHICLE
from tcs_hil.errors import ConfigError
from tcs_hil.hil.export.table import NS_PER_S, Instants
from tcs_hil.hil.logs.bench_clock import bench_ticks, sent_by
from tcs_hil.hil.logs.bus_log import stamp_ns
from tcs_hil.runtime.recording import RunInfo

PERIOD_NS = 2_000_000
"""Of the bench, where no flight recording says another."""


class Parts(NamedTuple):
    """What was read of a run, not yet aligned; empty where a part is missing.

    ``truth`` and ``jitter_ns`` are as in the plant's recording.
    """

    frames: Sequence[can.Message]
    ticks: NDArray[np.void] | None
    info: RunInfo | None
    truth: NDArray[np.void] | None
    jitter_ns: NDArray[np.int64]


class TimeBase(NamedTuple):
    """Instants of each part in ns since the start, and when that was, ns since 1970.

    ``order`` sorts the frames: (n,).
    """

    start_ns: int
    order: NDArray[np.intp]
    frames_ns: Instants  # in order
    ticks_ns: Instants
    truth_ns: Instants


def align(parts: Parts, dbc: CanDatabase) -> TimeBase:
    """Find the time base of a run.

    Raises:
        ConfigError: the log holds more than one run, or a truth in real time has
            no log to say when it began.
    """
    numbers = bench_ticks(parts.frames, dbc)
    if numbers is not None or _paced_by_a_bench(parts.ticks):
        return _on_the_bench(parts, numbers, dbc)
    return _on_the_calendar(parts, dbc)


def _paced_by_a_bench(ticks: NDArray[np.void] | None) -> bool:
    return ticks is not None and bool((ticks["now_ns"] != ticks["wake_ns"]).any())


def _on_the_bench(parts: Parts, numbers: NDArray[np.int64] | None, dbc: CanDatabase) -> TimeBase:
    period_ns = PERIOD_NS if parts.info is None else parts.info.period_ns
    frames_ns = np.empty(0, np.int64) if numbers is None else numbers * period_ns
    # A log may hold the answers to a tick after the next question.
    order = np.lexsort((~sent_by(parts.frames, dbc, VEHICLE), frames_ns))
    # Frames that never were on a bus carry the bench's time alone.
    start_ns = max(_first_ns(parts.frames), _started_ns(parts.info))
    ticks_ns = np.empty(0, np.int64) if parts.ticks is None else parts.ticks["now_ns"]
    return TimeBase(start_ns, order, frames_ns[order], ticks_ns, _truth_ns(parts))


def _on_the_calendar(parts: Parts, dbc: CanDatabase) -> TimeBase:
    frames_ns = np.array([stamp_ns(frame) for frame in parts.frames], dtype=np.int64)
    ticks_ns = np.empty(0, np.int64)
    if parts.ticks is not None and parts.info is not None:
        moved_ns = parts.info.started_realtime_ns - parts.info.started_monotonic_ns
        ticks_ns = parts.ticks["now_ns"] + moved_ns
    truth_ns = _truth_ns(parts)
    if len(truth_ns) and (len(frames_ns) or len(ticks_ns)):
        truth_ns = truth_ns + _plant_start_ns(parts, frames_ns, dbc)
    order = np.argsort(frames_ns, kind="stable")
    every = np.concatenate((frames_ns, ticks_ns, truth_ns))
    start_ns = int(every.min()) if len(every) else 0
    moved = (part - start_ns for part in (frames_ns[order], ticks_ns, truth_ns))
    return TimeBase(start_ns, order, *moved)


def _plant_start_ns(parts: Parts, frames_ns: Instants, dbc: CanDatabase) -> int:
    """The first instant of the truth: the plant's first frame, less the time it woke too late."""
    spoken_ns = frames_ns[sent_by(parts.frames, dbc, VEHICLE)]
    if not len(spoken_ns):
        raise ConfigError("the truth needs the bus log of its run to say when it began")
    late_ns = int(parts.jitter_ns[0]) if len(parts.jitter_ns) else 0
    return int(spoken_ns.min()) - late_ns


def _truth_ns(parts: Parts) -> Instants:
    if parts.truth is None:
        return np.empty(0, np.int64)
    return np.round(parts.truth["time_s"] * NS_PER_S).astype(np.int64)


def _first_ns(frames: Sequence[can.Message]) -> int:
    return stamp_ns(frames[0]) if frames else 0


def _started_ns(info: RunInfo | None) -> int:
    return 0 if info is None else info.started_realtime_ns
