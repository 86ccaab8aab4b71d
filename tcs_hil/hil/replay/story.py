"""A comparison in words: the first difference and what led to it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from tcs_hil.canbus.contract import NO_LIMIT_LABEL
from tcs_hil.canbus.database import Database
from tcs_hil.canbus.frame import Frame
from tcs_hil.hil.replay.compare import Comparison, Difference, shown
from tcs_hil.hil.replay.recorded import RecordedTick

FRAMES_BEFORE = 12
S_PER_NS = 1e-9


def tell(
    ticks: Sequence[RecordedTick], comparison: Comparison, database: Database
) -> Iterator[str]:
    """Lines for a reader: every signal of the first tick that differs, then the frames before."""
    for difference in comparison.first:
        tick = ticks[difference.place]
        time_s = (tick.now_ns - ticks[0].now_ns) * S_PER_NS
        yield (
            f"tick {tick.number}, {time_s:.3f} s: {difference.signal.name} was "
            f"{shown(difference.signal, difference.recorded)}, is "
            f"{shown(difference.signal, difference.replayed)}"
        )
    if comparison.first:
        yield "what was on the bus before, newest last:"
        for number, frame in _before(ticks, comparison.first[0].place):
            yield f"  tick {number}  {frame.frame_id:03X}  {_decoded(frame, database)}"


def as_dict(ticks: Sequence[RecordedTick], comparison: Comparison) -> dict[str, Any]:
    """The same as numbers, for JSON."""
    return {
        "ticks": comparison.ticks,
        "differing": comparison.differing,
        "largest_nm": comparison.largest_nm,
        "first": [_difference(ticks, each) for each in comparison.first],
    }


def _difference(ticks: Sequence[RecordedTick], difference: Difference) -> dict[str, Any]:
    tick = ticks[difference.place]
    return {
        "tick": tick.number,
        "time_s": (tick.now_ns - ticks[0].now_ns) * S_PER_NS,
        "signal": difference.signal.name,
        "recorded": _as_json(difference.recorded),
        "replayed": _as_json(difference.replayed),
    }


def _as_json(value: float) -> float | str | None:
    """JSON knows neither NaN nor infinity."""
    if math.isinf(value):
        return NO_LIMIT_LABEL
    return None if math.isnan(value) else value


def _before(ticks: Sequence[RecordedTick], place: int) -> list[tuple[int, Frame]]:
    """The newest frames that the replayed service had heard or should have sent by then."""
    frames = [
        (tick.number, frame)
        for tick in ticks[max(place - FRAMES_BEFORE, 0) : place]
        for frame in (*tick.inputs, *tick.answers)
    ]
    frames += [(ticks[place].number, frame) for frame in ticks[place].inputs]
    return frames[-FRAMES_BEFORE:]


def _decoded(frame: Frame, database: Database) -> str:
    for spec in database.messages.values():
        if (frame.frame_id, len(frame.data)) == (spec.frame_id, spec.length):
            values = zip(spec.signals, spec.codec.decode(frame.data), strict=True)
            told = (f"{signal.name}={shown(signal, value)}" for signal, value in values)
            return f"{spec.name}: {' '.join(told)}"
    return frame.data.hex()
