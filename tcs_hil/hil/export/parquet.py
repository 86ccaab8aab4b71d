"""Parquet: one wide table, units and value tables in the metadata of its columns."""

from __future__ import annotations

import json
from pathlib import Path

import pyarrow as pa
from pyarrow import parquet

from tcs_hil.hil.export.columns import Column, widen
from tcs_hil.hil.export.table import NS_PER_S, Run

TIME = pa.field("time_s", pa.float64(), metadata={"unit": "s"})


def write(path: Path, run: Run) -> None:
    """Write the decoded run; a cell is null where its source had nothing new at the instant."""
    parquet.write_table(arrow_table(run), path, compression="zstd")


def arrow_table(run: Run) -> pa.Table:
    """The wide table in memory; ``description`` is the metadata of its schema."""
    wide = widen(run)
    fields, arrays = [TIME], [pa.array(wide.time_ns / NS_PER_S)]
    for column in wide.columns:
        array = pa.array(column.values, mask=column.empty)
        fields.append(pa.field(column.name, array.type, metadata=_metadata(column)))
        arrays.append(array)
    return pa.Table.from_arrays(arrays, schema=pa.schema(fields, metadata=run.description))


def _metadata(column: Column) -> dict[str, str]:
    _, _, unit, comment, labels = column.channel
    about = {"unit": unit, "comment": comment, "labels": json.dumps(labels) if labels else ""}
    return {key: text for key, text in about.items() if text}
