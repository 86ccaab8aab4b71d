"""What a soak looks at: two processes from outside, and the service's own flight recording."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tcs_hil.runtime.recording import Bookmark, read_on
from tcs_hil.runtime.times import times_us

S_PER_H = 3600.0
COUNTERS = ("rx_frames", "tx_frames", "lost_frames", "bus_errors", "e2e_errors")


@dataclass(frozen=True, slots=True)
class Footprint:
    """What a process holds of the machine."""

    rss_kib: int
    descriptors: int
    threads: int

    @staticmethod
    def of(pid: int) -> Footprint:
        """Look at a running process; raises FileNotFoundError if it has ended."""
        process = Path("/proc", str(pid))
        lines = (process / "status").read_text().splitlines()
        status = dict(line.split(":", 1) for line in lines)
        descriptors = sum(1 for _ in (process / "fd").iterdir())
        return Footprint(int(status["VmRSS"].split()[0]), descriptors, int(status["Threads"]))


@dataclass(frozen=True, slots=True)
class Ticking:
    """What the service's recording has gained since the sample before.

    ``drift_ns`` is how far the newest tick was scheduled from its number's place
    on the grid that the first tick began.  Counters count since the start.
    """

    ticks: int
    skipped: int
    overruns: int
    failures: int
    active: int
    drift_ns: int
    jitter_p50_us: float
    jitter_p99_us: float
    rx_frames: int
    tx_frames: int
    lost_frames: int
    bus_errors: int
    e2e_errors: int


class Watcher:
    """Reads on in a flight recording from sample to sample."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._bookmark: Bookmark | None = None
        self._first: np.void | None = None

    def look(self) -> Ticking | None:
        """What is new; None where no tick was made."""
        ticks, self._bookmark = read_on(self._path, self._bookmark)
        if not len(ticks):
            return None
        newest = ticks[-1]
        first = self._first = ticks[0] if self._first is None else self._first
        periods = int(newest["number"] - first["number"])
        elapsed_ns = int(newest["scheduled_ns"] - first["scheduled_ns"])
        jitter_us = times_us(ticks)["wake_jitter"]
        p50_us, p99_us = np.quantile(jitter_us, (0.5, 0.99)).tolist()
        return Ticking(
            ticks=len(ticks),
            skipped=int(ticks["skipped"].sum()),
            overruns=int(ticks["overrun"].sum()),
            failures=int(ticks["failed"].sum()),
            active=int(np.isfinite(ticks["limit_fl_nm"]).sum()),
            drift_ns=elapsed_ns - periods * self._bookmark.run.period_ns,
            jitter_p50_us=p50_us,
            jitter_p99_us=p99_us,
            **{name: int(newest[name]) for name in COUNTERS},
        )


@dataclass(frozen=True, slots=True)
class Sample:
    """One look at everything, ``at_s`` after the service first heard the car."""

    at_s: float
    service: Footprint
    emulator: Footprint
    ticking: Ticking


@dataclass(frozen=True, slots=True)
class Verdict:
    """Whether the service ends as it began; growth is that of the fitted line."""

    growth_kib_per_h: float
    descriptors_constant: bool
    threads_constant: bool
    drift_ns: int
    failures: int

    GROWTH_MAX_KIB_PER_H = 1024.0
    """Half a byte a tick: what is forgotten in every tick is more than that."""

    @property
    def flat(self) -> bool:
        """Whether nothing grows and nothing drifts."""
        return (
            self.growth_kib_per_h < self.GROWTH_MAX_KIB_PER_H
            and self.descriptors_constant
            and self.threads_constant
            and self.drift_ns == 0
            and self.failures == 0
        )


def judge(samples: Sequence[Sample], warm_up_s: float) -> Verdict:
    """Judge the samples after the warm-up, two or more; drift and failures count in all."""
    late = [sample for sample in samples if sample.at_s >= warm_up_s]
    hours = [sample.at_s / S_PER_H for sample in late]
    slope, _ = np.polyfit(hours, [sample.service.rss_kib for sample in late], 1)
    return Verdict(
        growth_kib_per_h=float(slope),
        descriptors_constant=len({sample.service.descriptors for sample in late}) == 1,
        threads_constant=len({sample.service.threads for sample in late}) == 1,
        drift_ns=max(abs(sample.ticking.drift_ns) for sample in samples),
        failures=sum(sample.ticking.failures for sample in samples),
    )
