"""A recording replayed onto a bus, where a running service answers it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from tcs_hil.canbus.contract import TCS
from tcs_hil.canbus.database import Database
from tcs_hil.canbus.frame import Frame
from tcs_hil.errors import BusError
from tcs_hil.hil.replay.recorded import Answers, RecordedTick
from tcs_hil.runtime.clock import Clock
from tcs_hil.runtime.seams import Port

ANSWER_TIMEOUT_NS = 10_000_000_000
POLL_S = 0.1
LEAD_NS = 100_000_000
"""From the call to the first frame: every cyclic message of the service has come by then."""


def replay_in_lockstep(
    ticks: Sequence[RecordedTick], port: Port, clock: Clock, database: Database
) -> Answers:
    """Pace a service that was started with ``--trigger lockstep``, as the bench did.

    Raises:
        BusError: the service is silent.
    """
    port.receive()  # what was said before is no answer
    answers: Answers = []
    for tick in ticks:
        for frame in tick.inputs:  # BenchTick is the last of them
            port.send(frame.frame_id, frame.data)
        answers.append(_answers_to(tick, port, clock, database))
    return answers


def _answers_to(
    tick: RecordedTick, port: Port, clock: Clock, database: Database
) -> tuple[Frame, ...]:
    done = database.messages["BenchTickDone"]
    give_up_ns = clock.now_ns() + ANSWER_TIMEOUT_NS
    heard: list[Frame] = []
    while clock.now_ns() < give_up_ns:
        port.wait(POLL_S)
        for frame in port.receive():
            heard.append(frame)
            if frame.frame_id == done.frame_id and done.codec.decode(frame.data)[0] == tick.number:
                return tuple(heard)
    raise BusError(
        f"no answer to tick {tick.number}; start `tcs-hil run --trigger lockstep` on this bus first"
    )


def replay_in_real_time(
    ticks: Sequence[RecordedTick], port: Port, clock: Clock, database: Database, period_ns: int
) -> Answers:
    """Send each frame as long after the first as it was recorded; sort the answers by their time.

    The recording is moved in time by whole periods: a service that ticks on the
    grid then has the phase it had.

    Raises:
        BusError: the service is silent.
    """
    frames = [frame for tick in ticks for frame in tick.inputs]
    earliest_ns = clock.now_ns() + LEAD_NS
    moved_ns = -((frames[0].stamp_ns - earliest_ns) // period_ns) * period_ns
    own = database.frame_ids_of(TCS)
    answers: list[list[Frame]] = [[] for _ in ticks]
    now_ns = np.array([tick.now_ns for tick in ticks])
    for heard in _play(frames, ticks[-1].now_ns + period_ns, moved_ns, port, clock):
        if heard.frame_id in own:
            # A tick may wake a little sooner than the recorded one.
            place = np.searchsorted(now_ns, heard.stamp_ns - moved_ns + period_ns // 4, "right")
            answers[max(int(place) - 1, 0)].append(heard)
    if not any(answers):
        raise BusError("no answer; start `tcs-hil run` on this bus first")
    return list(map(tuple, answers))


def _play(
    frames: Sequence[Frame], end_ns: int, moved_ns: int, port: Port, clock: Clock
) -> Iterator[Frame]:
    """Send at the recorded instants up to the end; what was heard meanwhile."""
    for frame in frames:
        clock.sleep_until(frame.stamp_ns + moved_ns)
        yield from port.receive()
        port.send(frame.frame_id, frame.data)
    clock.sleep_until(end_ns + moved_ns)
    yield from port.receive()
