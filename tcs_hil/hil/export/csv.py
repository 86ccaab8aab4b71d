"""CSV: the wide table of the Parquet file, with units in its headings."""

from __future__ import annotations

from pathlib import Path

from pyarrow import csv

from tcs_hil.hil.export.parquet import arrow_table
from tcs_hil.hil.export.table import Run
from tcs_hil.names import NO_UNIT

LONG = "scenario"
"""Text of some thousand characters: the other formats have it."""


def write(path: Path, run: Run) -> None:
    """Write what the run was as comments (``#``), then headings and rows."""
    table = arrow_table(run)
    headings = [_heading(field.name, field.metadata[b"unit"].decode()) for field in table.schema]
    with path.open("wb") as file:
        for key, text in run.description.items():
            if key != LONG:
                file.write(f"# {key}: {text}\n".encode())
        csv.write_csv(table.rename_columns(headings), file)


def _heading(name: str, unit: str) -> str:
    """``time_s`` and its like say their unit already."""
    return name if unit == NO_UNIT or "." not in name else f"{name} [{unit}]"
