"""Scores as cells of a table and as JSON."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from tcs_hil.hil.machine import describe_machine
from tcs_hil.hil.metrics import Score

HEADINGS = ("RMSE", "peak", "speed gained / ideal", "mean abs dT/dt, Nm/s", "limit cycle")


def cells(score: Score) -> list[str]:
    """One run, in the order of ``HEADINGS``."""
    slip, cycle = score.slip, score.limit_cycle
    return [
        f"{slip.rmse_ratio:.4f}",
        f"{slip.peak_ratio:.3f}",
        f"{score.gain_ratio:.3f}",
        f"{slip.chatter_nmps:.0f}",
        f"{cycle.frequency_hz:.0f} Hz" if cycle else "none",
    ]


def as_json(rows: Sequence[object]) -> bytes:
    """Rows and the machine that made them; NaN becomes null."""
    return msgspec.json.encode({"machine": describe_machine(), "rows": rows})
