"""Which file is written how, by its suffix."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from pathlib import Path

from tcs_hil.errors import ConfigError
from tcs_hil.hil.export.table import Run

Writer = Callable[[Path, Run], None]

FRAMES_ALONE = ".log"
MODULES = {".mf4": "mf4", ".parquet": "parquet", ".csv": "csv", FRAMES_ALONE: "candump"}


def writer_of(path: Path) -> Writer:
    """What writes a file of this name; its libraries are imported here and not before.

    Raises:
        ConfigError: nothing does, a library is missing, or there is no such folder.
    """
    module = MODULES.get(path.suffix.lower())
    if module is None:
        raise ConfigError(f"{path}: the suffix must be one of {', '.join(MODULES)}")
    if not path.absolute().parent.is_dir():
        raise ConfigError(f"{path}: there is no such folder to write into")
    try:
        writer: Writer = importlib.import_module(f"tcs_hil.hil.export.{module}").write
    except ModuleNotFoundError as error:
        needed = f"{path}: needs {error.name}, which comes with pip install 'tcs-hil[bench]'"
        raise ConfigError(needed) from error
    return writer


def contents(path: Path, run: Run) -> dict[str, int]:
    """How much of a run a file of this name holds: counts by what is counted, in the singular."""
    frames = {"frame": len(run.frames)}
    if path.suffix.lower() == FRAMES_ALONE:
        return frames
    samples = sum(len(table.time_ns) for table in run.tables)
    return {"sample": samples, "source": len(run.tables), **frames}
