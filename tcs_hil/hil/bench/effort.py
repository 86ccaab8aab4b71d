"""How much each part of the benchmark repeats: for figures, or to see that everything works."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

Progress = Callable[[float, str], None]
"""Hears of the share of a part that is done, and of what comes next."""


class Effort(NamedTuple):
    """Repetitions; the whole of ``FULL`` takes less than five minutes on a quiet machine."""

    questions: int  # to a law, at most
    repeats: int  # of a drive, for our own laws and for ticks
    ticks: int  # of a drive, at most
    horizons: tuple[int, ...]
    orders: tuple[int, ...]
    bus_s: float
    starts: int


FULL = Effort(
    questions=10_000,
    repeats=6,
    ticks=1500,
    horizons=(5, 10, 20, 40),
    orders=(1, 2, 3, 4, 5, 6),
    bus_s=60.0,
    starts=3,
)
QUICK = Effort(
    questions=200,
    repeats=1,
    ticks=200,
    horizons=(5, 20),
    orders=(2, 4),
    bus_s=1.0,
    starts=1,
)
