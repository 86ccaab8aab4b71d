"""The truth on record: a NumPy file with one row per grid instant, filled while running."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np
from numpy.typing import NDArray

from plant_emulator.scenario import Scenario
from plant_emulator.truth import ROW_SIZE, TRUTH_DTYPE, Row
from tcs_hil.errors import ConfigError

_TOO_LONG = "the truth does not fit into memory after {} rows: make `duration_s` shorter"

CHUNK_ROWS = 5000
"""Memory is taken for 10 s at a time."""


class TruthRecorder:
    """Collects rows in memory and writes them as ``.npz`` at the end.

    Without a ``path`` it keeps nothing, unless ``in_memory`` asks for `rows`.

    ``numpy.load(path)`` holds ``truth`` (rows of `TRUTH_DTYPE`, the first at
    time zero), ``jitter_ns`` (wake - scheduled; empty in lockstep) and
    ``scenario`` (JSON text of the scenario as run).
    """

    def __init__(self, path: Path | None, scenario: Scenario, *, in_memory: bool = False) -> None:
        self._path = path
        self._scenario = msgspec.json.encode(scenario).decode()
        self._keeps = path is not None or in_memory
        self._chunks: list[NDArray[np.float64]] = []  # all full but the last
        self._count = 0
        self.save()  # a path that cannot be written is refused before the run, not after it

    def add(self, row: Row) -> None:
        """Append one row.

        Raises:
            ConfigError: the run is too long to be kept in memory.
        """
        if not self._keeps:
            return
        place = self._count % CHUNK_ROWS
        try:
            if place == 0:
                self._chunks.append(np.empty((CHUNK_ROWS, ROW_SIZE)))
        except MemoryError as error:
            raise ConfigError(_TOO_LONG.format(self._count)) from error
        self._chunks[-1][place] = row
        self._count += 1

    @property
    def rows(self) -> NDArray[np.void]:
        """What was collected so far, in the order of time."""
        free = len(self._chunks) * CHUNK_ROWS - self._count
        *full, last = self._chunks or [np.empty((0, ROW_SIZE))]
        return np.concatenate([*full, last[: len(last) - free]]).view(TRUTH_DTYPE)[:, 0]

    def save(self, jitter_ns: NDArray[np.int64] | None = None) -> None:
        """Write what was collected; nothing without a path.

        Raises:
            ConfigError: the file cannot be written, or the run is too long for it.
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
        except MemoryError as error:
            raise ConfigError(_TOO_LONG.format(self._count)) from error
        except OSError as error:
            raise ConfigError(f"{self._path}: cannot be written ({error.strerror})") from error
