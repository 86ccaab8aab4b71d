"""The time of a lockstep run: ticks the bench counted, whatever the clock on the wall did."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import can
import numpy as np
from cantools.database.can import Database as CanDatabase
from cantools.database.can import Message
from numpy.typing import NDArray

from tcs_hil.canbus.contract import TCS
from tcs_hil.errors import ConfigError

Numbers = NDArray[np.int64]  # (n,)

TICK, TICK_NUMBER = "BenchTick", "BenchTickNumber"
DONE, DONE_NUMBER = "BenchTickDone", "BenchTickAnswered"


def message_named(dbc: CanDatabase, name: str) -> Message | None:
    """The message of this name, None where the DBC has none."""
    return next((message for message in dbc.messages if message.name == name), None)


def sent_by(messages: Sequence[can.Message], dbc: CanDatabase, node: str) -> NDArray[np.bool_]:
    """Which frames (n,) only ``node`` may send."""
    own = {message.frame_id for message in dbc.messages if node in message.senders}
    return np.array([message.arbitration_id in own for message in messages], dtype=bool)


def bench_ticks(messages: Sequence[can.Message], dbc: CanDatabase) -> Numbers | None:
    """Number of the tick each frame belongs to, (n,); None where no bench paced the run.

    Each node's frames are in order, but a log may hold them in between each
    other as its bus pleased: what the vehicle sent up to ``BenchTick`` k and the
    service up to ``BenchTickDone`` k is of tick k.

    Raises:
        ConfigError: the numbers fall, as when two runs were recorded into one log.
    """
    answers = sent_by(messages, dbc, TCS)
    ticks = np.zeros(len(messages), dtype=np.int64)
    announced = _marks(messages, message_named(dbc, TICK), TICK_NUMBER)
    if not len(announced[0]):
        return None
    done = _marks(messages, message_named(dbc, DONE), DONE_NUMBER)
    for chosen, marks in ((~answers, announced), (answers, done)):
        ticks[chosen] = _ticks_at(np.flatnonzero(chosen), *marks)
    return ticks


def _marks(
    messages: Sequence[can.Message], kind: Message | None, signal: str
) -> tuple[Numbers, Numbers]:
    """Places in the log at which a tick is closed, and the numbers of those ticks."""
    places = [
        place
        for place, message in enumerate(messages)
        if kind is not None and message.arbitration_id == kind.frame_id
    ]
    numbers = [_number(kind, messages[place], signal) for place in places if kind is not None]
    if any(later < earlier for earlier, later in pairwise(numbers)):
        raise ConfigError("the bench's ticks count from the start again: more than one run")
    return np.array(places, dtype=np.int64), np.array(numbers, dtype=np.int64)


def _number(kind: Message, message: can.Message, signal: str) -> int:
    values = kind.decode(bytes(message.data), decode_choices=False)
    return int(values[signal])  # type: ignore[call-overload, arg-type]


def _ticks_at(places: Numbers, marks: Numbers, numbers: Numbers) -> Numbers:
    """What comes after the last mark is of a tick that was never closed."""
    open_tick = numbers[-1] + 1 if len(numbers) else 0
    found: Numbers = np.append(numbers, open_tick)[np.searchsorted(marks, places)]
    return found
