"""Frames of a log as tables: one per message of the DBC, decoded by cantools."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence

import can
import numpy as np
from cantools.database.can import Database as CanDatabase
from cantools.database.can import Message, Signal
from cantools.database.errors import DecodeError

from tcs_hil.hil.export.table import Channel, Instants, Table
from tcs_hil.names import NO_UNIT

Decoded = dict[str, float]


def message_tables(
    messages: Sequence[can.Message], time_ns: Instants, dbc: CanDatabase
) -> Iterator[Table]:
    """A table for each message of ``dbc`` that was seen, lowest identifier first.

    Frames the DBC does not know, or that are too short to decode, are left out;
    so are the values of a signal that its multiplexer did not send (NaN).
    """
    places: dict[tuple[int, bool], list[int]] = defaultdict(list)
    for place, message in enumerate(messages):
        places[message.arbitration_id, message.is_extended_id].append(place)
    for kind in sorted(dbc.messages, key=lambda kind: kind.frame_id):
        seen = places.get((kind.frame_id, kind.is_extended_frame), [])
        decoded = {place: values for place in seen if (values := _decode(kind, messages[place]))}
        if decoded:
            yield _table(kind, time_ns[list(decoded)], list(decoded.values()))


def _decode(kind: Message, message: can.Message) -> Decoded | None:
    try:
        # Numbers throughout: a cell must not be a word in one row and a number in the next.
        return kind.decode(bytes(message.data), decode_choices=False)  # type: ignore[return-value]
    except (DecodeError, ValueError):
        return None


def _table(kind: Message, time_ns: Instants, decoded: list[Decoded]) -> Table:
    channels = tuple(
        _channel(signal, [values.get(signal.name, np.nan) for values in decoded])
        for signal in kind.signals
    )
    return Table(kind.name, kind.comment or "", time_ns, channels)


def _channel(signal: Signal, values: list[float]) -> Channel:
    labels = {int(raw): str(label) for raw, label in (signal.choices or {}).items()}
    counts = (signal.scale, signal.offset) == (1, 0)
    return Channel(
        signal.name,
        np.array(values),
        signal.unit or NO_UNIT,
        signal.comment or "",
        # Labels name raw values: those of a scaled signal are told by its comment alone.
        labels if counts else {},
    )
