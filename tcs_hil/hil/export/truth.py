"""The plant's truth as a table: what no controller ever saw."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tcs_hil.hil.export.table import Channel, Instants, Table
from tcs_hil.names import column_names, unit_of

COMMENT = "What really happened in the plant; time_s is the scenario's own"


def truth_table(rows: NDArray[np.void], time_ns: Instants) -> Table:
    """Every field of the truth, (n,), a channel for each wheel."""
    names = rows.dtype.names or ()
    channels = tuple(channel for name in names for channel in _channels(name, rows[name]))
    return Table("truth", COMMENT, time_ns, channels)


def _channels(name: str, values: NDArray[Any]) -> Iterator[Channel]:
    names = column_names(name, values.shape[1:])
    for each, column in zip(names, np.atleast_2d(values.T), strict=True):
        yield Channel(each, np.ascontiguousarray(column), unit_of(each))
