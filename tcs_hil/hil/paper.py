"""What the paper reports, to stand beside our own figures (its Table III, on a PC)."""

from __future__ import annotations

from typing import NamedTuple


class SolveTime(NamedTuple):
    """Time of one controller step in µs."""

    mean_us: float
    max_us: float


SOLVE_TIMES = {
    ("manoeuvre-1", "kmpc"): SolveTime(4.0, 43.2),
    ("manoeuvre-1", "nmpc"): SolveTime(197.0, 600.0),
    ("manoeuvre-2", "kmpc"): SolveTime(3.7, 62.7),
    ("manoeuvre-2", "nmpc"): SolveTime(210.0, 507.0),
}

MANOEUVRES = {
    "manoeuvre-1": "Constant friction, mu 0.3",
    "manoeuvre-2": "Varying friction, mu 0.3 - 0.15 - 0.6 - 0.3",
}
