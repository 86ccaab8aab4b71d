"""Scores as cells of a table."""

from __future__ import annotations

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
