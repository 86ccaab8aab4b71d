"""A run as one wide table: a row per instant, a column per channel, empty where nothing was new."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tcs_hil.hil.export.table import Channel, Instants, Run

Places = NDArray[np.int64]  # (n,), the row of each sample


class Column(NamedTuple):
    """A channel over all rows; ``values`` mean nothing where ``empty``: both (rows,)."""

    name: str
    channel: Channel
    values: NDArray[Any]
    empty: NDArray[np.bool_]


class Wide(NamedTuple):
    """``time_ns`` (rows,) and the columns, which are made while they are taken."""

    time_ns: Instants
    columns: Iterator[Column]


def widen(run: Run) -> Wide:
    """Bring all tables of ``run`` onto the instants at which any of them has a sample.

    A table with several samples at one instant takes as many rows for it, so
    that nothing is lost.

    Raises:
        ConfigError: there is no table.
    """
    keys = [_keys(table.time_ns) for table in run.decoded]
    rows, inverse = np.unique(np.concatenate(keys), axis=0, return_inverse=True)
    places = np.split(inverse, np.cumsum([len(table.time_ns) for table in run.tables])[:-1])
    return Wide(rows[:, 0], _columns(run, places, len(rows)))


def _keys(time_ns: Instants) -> NDArray[np.int64]:
    """Instant and count within the instant of each sample: (n, 2)."""
    first = np.searchsorted(time_ns, time_ns)
    return np.column_stack((time_ns, np.arange(len(time_ns)) - first))


def _columns(run: Run, places: list[Places], rows: int) -> Iterator[Column]:
    for table, place in zip(run.tables, places, strict=True):
        empty = np.ones(rows, dtype=bool)
        empty[place] = False
        for channel in table.channels:
            values = np.zeros(rows, channel.values.dtype)
            values[place] = channel.values
            yield Column(table.full_name(channel), channel, values, empty)
