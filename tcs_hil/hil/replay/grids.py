"""Three ways to find the ticks of a recorded service, the exact ones first."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Iterable, Iterator
from itertools import count
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tcs_hil.canbus.contract import TCS
from tcs_hil.canbus.database import Database
from tcs_hil.canbus.frame import Frame
from tcs_hil.hil.logs.bench_clock import TICK
from tcs_hil.hil.replay.recorded import RecordedTick
from tcs_hil.runtime.recording import RunInfo
from tcs_hil.signals import BusCondition

CLOCKS_APART_NS = 100_000
"""Between the service's stamp of a frame and the log's, on clocks read one after the other."""

EARLY_TICKS = 100


class Parted(NamedTuple):
    """What the service heard and what it said, each oldest first."""

    inputs: list[Frame]
    answers: list[Frame]


def part(frames: Iterable[Frame], database: Database) -> Parted:
    """Part the frames of a log by who may send them, in the order of their stamps."""
    own = database.frame_ids_of(TCS)
    parted = Parted([], [])
    for frame in sorted(frames, key=lambda frame: frame.stamp_ns):
        (parted.answers if frame.frame_id in own else parted.inputs).append(frame)
    return parted


def on_the_bench(
    frames: Iterable[Frame], numbers: Iterable[int], database: Database, period_ns: int
) -> Iterator[RecordedTick]:
    """Ticks of a lockstep run: the number of each frame's tick says where it belongs."""
    own = database.frame_ids_of(TCS)
    tick_id = database.messages[TICK].frame_id
    inputs: dict[int, list[Frame]] = defaultdict(list)
    answers: dict[int, list[Frame]] = defaultdict(list)
    for frame, number in zip(frames, numbers, strict=True):
        part = answers if frame.frame_id in own else inputs
        part[number].append(frame._replace(stamp_ns=number * period_ns))
    for number, heard in sorted(inputs.items()):
        # A tick that was not announced, which can be the last one only, was never made.
        if heard[-1].frame_id == tick_id:
            yield RecordedTick(number, number * period_ns, tuple(heard), tuple(answers[number]))


def at_recorded_ticks(
    parted: Parted, ticks: NDArray[np.void], run: RunInfo
) -> Iterator[RecordedTick]:
    """Ticks of a flight recording, (n,): it says when each was and how many frames it took."""
    moved_ns = run.started_monotonic_ns - run.started_realtime_ns
    pending = deque(_moved(parted.inputs, moved_ns))
    for _ in range(_unheard([frame.stamp_ns for frame in pending], ticks)):
        pending.popleft()
    answers = _by_tick(_moved(parted.answers, moved_ns), ticks)
    for tick, said in zip(ticks, answers, strict=True):
        heard = _take(pending, tick)
        yield RecordedTick(int(tick["number"]), int(tick["now_ns"]), heard, said, _bus(tick))


def at_the_limits(parted: Parted, limit_id: int) -> Iterator[RecordedTick]:
    """Ticks as the torque limits tell: each is the end of one, whose inputs came before it."""
    pending, answers = deque(parted.inputs), list[Frame]()
    number = count()
    for answer in parted.answers:
        answers.append(answer)
        if answer.frame_id != limit_id:
            continue
        inputs = list[Frame]()
        while pending and pending[0].stamp_ns <= answer.stamp_ns:
            inputs.append(pending.popleft())
        yield RecordedTick(next(number), answer.stamp_ns, tuple(inputs), tuple(answers))
        answers.clear()


def _moved(frames: Iterable[Frame], moved_ns: int) -> Iterator[Frame]:
    return (frame._replace(stamp_ns=frame.stamp_ns + moved_ns) for frame in frames)


def _unheard(stamps_ns: list[int], ticks: NDArray[np.void]) -> int:
    """Frames that had come before the service listened, or before the ring's oldest tick.

    Of the early ticks most found at their drain what had come and no more; the
    others were ahead of a backlog or of a frame that came meanwhile.
    """
    early = ticks[:EARLY_TICKS]
    came = np.searchsorted(stamps_ns, early["received_ns"], side="right")
    return max(int(np.median(came - np.cumsum(early["frames"]))), 0)


def _take(pending: deque[Frame], tick: np.void) -> tuple[Frame, ...]:
    latest_ns = int(tick["received_ns"]) + CLOCKS_APART_NS
    taken = list[Frame]()
    while len(taken) < tick["frames"] and pending and pending[0].stamp_ns <= latest_ns:
        taken.append(pending.popleft())
    return tuple(taken)


def _bus(tick: np.void) -> BusCondition:
    """Recordings made before there was such a field say nothing against the bus."""
    known = "bus_condition" in (tick.dtype.names or ())
    return BusCondition(tick["bus_condition"]) if known else BusCondition.OK


def _by_tick(answers: Iterable[Frame], ticks: NDArray[np.void]) -> list[tuple[Frame, ...]]:
    """Answers by the tick that sent them: between its waking and the next one's."""
    found: list[list[Frame]] = [[] for _ in range(len(ticks))]
    for answer in answers:
        place = int(np.searchsorted(ticks["wake_ns"], answer.stamp_ns)) - 1
        if place >= 0:
            found[place].append(answer)
    return [tuple(frames) for frames in found]
