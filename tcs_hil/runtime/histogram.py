"""Percentile tables in the text format of HdrHistogram (``.hgrm``), as its plotters read it."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

LINES_PER_HALVING = 5
HEADING = f"{'Value':>12} {'Percentile':>14} {'TotalCount':>10} {'1/(1-Percentile)':>14}\n\n"


def hgrm(samples: NDArray[np.float64]) -> str:
    """Return the table of ``samples`` (n,), n > 0, in their own unit.

    Every line is a value that occurred, the share of samples that do not exceed
    it, and their number; lines get denser towards the maximum.  HdrHistogram puts
    values into bins to save memory; a flight recording has every one of them, so
    the values here are exact.  Source: HdrHistogram's ``outputPercentileDistribution``.
    """
    ordered = np.sort(samples)
    shares = list(_shares(len(ordered)))
    values = np.quantile(ordered, shares, method="inverted_cdf").tolist()
    counts = np.searchsorted(ordered, values, side="right").tolist()
    lines = [_line(*row) for row in zip(values, shares, counts, strict=True)]
    return f"{HEADING}{''.join(lines)}{_footer(ordered)}"


def _shares(samples: int) -> Iterator[float]:
    """Shares at five steps per halving of what is left, up to the last sample; then 1."""
    for step in itertools.count():
        halvings, part = divmod(step, LINES_PER_HALVING)
        left = 0.5**halvings * (1.0 - 0.5 * part / LINES_PER_HALVING)
        if left * samples < 1.0:
            break
        yield 1.0 - left
    yield 1.0


def _line(value: float, share: float, count: int) -> str:
    one_in = f" {1.0 / (1.0 - share):14.2f}" if share < 1.0 else ""
    return f"{value:12.3f} {share:14.12f} {count:10d}{one_in}\n"


def _footer(ordered: NDArray[np.float64]) -> str:
    mean, deviation = float(ordered.mean()), float(ordered.std())
    return (
        f"#[Mean    = {mean:12.3f}, StdDeviation   = {deviation:12.3f}]\n"
        f"#[Max     = {float(ordered[-1]):12.3f}, Total count    = {len(ordered):12d}]\n"
        f"#[Buckets = {1:12d}, SubBuckets     = {len(ordered):12d}]\n"
    )
