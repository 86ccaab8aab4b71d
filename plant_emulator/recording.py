"""The truth on record: a NumPy file with one row per grid instant, filled while running."""

from __future__ import annotations

import math
from pathlib import Path

import msgspec
import numpy as np
from numpy.typing import NDArray

from plant_emulator.scenario import Scenario
from plant_emulator.truth import ROW_SIZE, TRUTH_DTYPE, Row
from tcs_hil.errors import ConfigError


class TruthRecorder:
    """Collects rows in memory taken beforehand and writes them as ``.npz`` at the end.

    ``numpy.load(path)`` holds ``truth`` (rows of `TRUTH_DTYPE`, the first at
    time zero), ``jitter_ns`` (wake - scheduled; empty in lockstep) and
    ``scenario`` (JSON text of the scenario as run).
    """

    def __init__(self, path: Path | None, scenario: Scenario, period_s: float) -> None:
        self._path = path
        self._scenario = msgspec.json.encode(scenario).decode()
        self._rows = np.zeros((math.ceil(scenario.duration_s / period_s) + 2, ROW_SIZE))
        self._count = 0
        self.save()  # a path that cannot be written is refused before the run, not after it

    def add(self, row: Row) -> None:
        """Append one row; rows beyond the scenario's duration are dropped."""
        if self._count < len(self._rows):
            self._rows[self._count] = row
            self._count += 1

    @property
    def rows(self) -> NDArray[np.void]:
        """What was collected so far, in the order of time."""
        return self._rows[: self._count].view(TRUTH_DTYPE)[:, 0]

    def save(self, jitter_ns: NDArray[np.int64] | None = None) -> None:
        """Write what was collected; nothing without a path.

        Raises:
            ConfigError: the file cannot be written.
        """
        if self._path is None:
            return
        jitter_ns = np.empty(0, np.int64) if jitter_ns is None else jitter_ns
        try:
            with self._path.open("wb") as file:
                np.savez(
                    file,
                    truth=self.rows,
                    jitter_ns=jitter_ns,
                    scenario=np.array(self._scenario),
                )
        except OSError as error:
            raise ConfigError(f"{self._path}: cannot be written ({error.strerror})") from error
