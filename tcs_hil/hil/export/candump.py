"""The frames as a candump log, which canplayer and log2asc read."""

from __future__ import annotations

from pathlib import Path

import can

from tcs_hil.errors import ConfigError
from tcs_hil.hil.export.table import NS_PER_S, Run


def write(path: Path, run: Run) -> None:
    """Write every frame in its order, stamped with the calendar time of the run's time base.

    Raises:
        ConfigError: there is no frame.
    """
    if not run.frames:
        raise ConfigError(f"{path}: candump knows frames alone, and the run has no bus log")
    start_s = run.start_ns / NS_PER_S
    with can.CanutilsLogWriter(path) as writer:
        for frame in run.frames:
            dated = frame.__copy__()
            dated.timestamp += start_s
            writer(dated)
