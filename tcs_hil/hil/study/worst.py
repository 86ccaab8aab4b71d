"""Which runs of a study one would look at first."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tcs_hil.hil.study.trial import Row


def success_share(rows: Sequence[Row]) -> float:
    """Share of the runs that kept every limit."""
    return sum(bool(row["success"]) for row in rows) / len(rows)


def worst(rows: Sequence[Row], count: int) -> list[Row]:
    """The ``count`` worst: broken runs, lost wheels, limit cycles, then the greatest errors."""
    return sorted(rows, key=_badness, reverse=True)[:count]


def _badness(row: Row) -> tuple[bool, bool, float, bool, float]:
    rmse = row["rmse_ratio"]
    spin_s = 0.0 if math.isnan(row["spin_s"]) else row["spin_s"]
    cycling = row["limit_cycle_hz"] > 0.0
    return (
        bool(row["error"]),
        not row["success"],
        spin_s,
        cycling,
        0.0 if math.isnan(rmse) else rmse,
    )
