"""Times of many repetitions in a few figures, and the quiet in which they are taken."""

from __future__ import annotations

import gc
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Self

import msgspec
import numpy as np
from numpy.typing import ArrayLike, NDArray

Times = NDArray[np.float64]

CLOCK_READINGS = 2001


class Statistics(msgspec.Struct, frozen=True):
    """Of one kind of time, in µs; every percentile is a value that occurred."""

    samples: int
    mean_us: float
    p50_us: float
    p99_us: float
    p99_9_us: float
    max_us: float

    @classmethod
    def of(cls, times_us: ArrayLike) -> Self:
        """Statistics of times (n,) in µs, n > 0."""
        times = np.asarray(times_us, np.float64)
        shares = (0.5, 0.99, 0.999, 1.0)
        percentiles = np.quantile(times, shares, method="inverted_cdf").tolist()
        figures = (float(times.mean()), *percentiles)
        return cls(len(times), *(round(figure, 3) for figure in figures))


class Cost(msgspec.Struct, frozen=True):
    """Wall time contains whatever else the machine did meanwhile, CPU time of the thread not."""

    wall: Statistics
    cpu: Statistics


class Stopwatch:
    """Times stretches of one thread by both clocks, less what reading the clocks takes by itself.

    ``start()`` and ``stop()`` go around what is timed, and nothing else.
    """

    def __init__(self) -> None:
        self._wall_ns: list[int] = []
        self._cpu_ns: list[int] = []
        for _ in range(CLOCK_READINGS):
            self.start()
            self.stop()
        self._floor_ns = np.median(self._wall_ns), np.median(self._cpu_ns)
        self._wall_ns.clear()
        self._cpu_ns.clear()

    def start(self) -> None:
        """Begin a time."""
        self._cpu = time.thread_time_ns()
        self._wall = time.perf_counter_ns()

    def stop(self) -> None:
        """End it."""
        wall, cpu = time.perf_counter_ns(), time.thread_time_ns()
        self._wall_ns.append(wall - self._wall)
        self._cpu_ns.append(cpu - self._cpu)

    @property
    def cost(self) -> Cost:
        """Of all times so far, of which there must be one."""
        return Cost(*map(Statistics.of, (self.wall_us, self._cpu_us)))

    @property
    def _cpu_us(self) -> Times:
        return _less(self._cpu_ns, self._floor_ns[1])

    @property
    def wall_us(self) -> Times:
        """Wall times so far, in order: (n,)."""
        return _less(self._wall_ns, self._floor_ns[0])


def _less(times_ns: Sequence[int], floor_ns: float) -> Times:
    return np.maximum(np.array(times_ns) - floor_ns, 0.0) / 1e3


@contextmanager
def quiet_collector() -> Iterator[None]:
    """Garbage collection off, as the service has it in its loop."""
    gc.collect()
    gc.freeze()
    gc.disable()
    try:
        yield
    finally:
        gc.enable()
        gc.unfreeze()
