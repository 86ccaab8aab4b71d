"""Follows a running service through its flight recording and adds up what it sees."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tcs_hil.runtime.recording import Bookmark, RunInfo, read_on
from tcs_hil.runtime.times import times_us

BOUNDS_US = (5, 10, 20, 50, 100, 200, 500, 1_000, 2_000, 5_000, 10_000, 100_000)
"""Upper bounds of the histograms' bins; the last bin has none."""


@dataclass(slots=True)
class Histogram:
    """Samples counted by bin: those up to each of ``BOUNDS_US``, then the rest."""

    bins: NDArray[np.int64] = field(
        default_factory=lambda: np.zeros(len(BOUNDS_US) + 1, dtype=np.int64)
    )
    sum_us: float = 0.0

    def add(self, samples_us: NDArray[np.float64]) -> None:
        """Count more samples: (m,)."""
        places = np.searchsorted(BOUNDS_US, samples_us, side="left")
        self.bins += np.bincount(places, minlength=len(self.bins))
        self.sum_us += float(samples_us.sum())


@dataclass(slots=True)
class Totals:
    """What a run has added up to; ``unseen`` ticks had left the ring before anybody looked.

    ``newest`` is the last tick as a record of ``recording.read``, None before the
    first.  Counters of the bus are the service's own and so in the newest tick.
    """

    run: RunInfo
    ticks: int = 0
    unseen: int = 0
    overruns: int = 0
    skipped: int = 0
    failures: int = 0
    times: dict[str, Histogram] = field(default_factory=dict)
    newest: np.void | None = None

    def add(self, ticks: NDArray[np.void], made: int) -> None:
        """Add ticks (n,) that came after the ones before; ``made`` is how many there are now."""
        self.unseen += made - self.ticks - len(ticks)
        self.ticks = made
        if not len(ticks):
            return
        self.overruns += int(ticks["overrun"].sum())
        self.skipped += int(ticks["skipped"].sum())
        self.failures += int(ticks["failed"].sum())
        before_ns = 0 if self.newest is None else int(self.newest["wheel_stamp_ns"])
        for name, samples_us in times_us(ticks, before_ns).items():
            self.times.setdefault(name, Histogram()).add(samples_us)
        self.newest = ticks[-1]


class Follower:
    """Reads on in a recording whenever it is asked; a new run starts from zero."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._bookmark: Bookmark | None = None
        self._totals: Totals | None = None

    def totals(self) -> Totals:
        """Read what is new and return the totals of the present run.

        Raises:
            RecordingError: there is no recording, or it cannot be read.
        """
        ticks, self._bookmark = read_on(self._path, self._bookmark)
        if self._totals is None or self._totals.run != self._bookmark.run:
            self._totals = Totals(self._bookmark.run)
        self._totals.add(ticks, self._bookmark.made)
        return self._totals
