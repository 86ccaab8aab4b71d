"""A toothed wheel-speed sensor on a wheel of known speed."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

PERIOD_S, RADIUS_M = 0.002, 0.318


def toothed(
    speed_mps: Callable[[float], float], duration_s: float
) -> Iterator[tuple[float, float]]:
    """Time and speed shown: the mean between the last two of 96 edges a turn, held in between."""
    pitch_m = 2.0 * math.pi * RADIUS_M / 96.0
    step_s, travelled_m, shown_mps, edge_s, edges = 1e-4, 0.0, speed_mps(0.0), 0.0, 0
    for step in range(round(duration_s / step_s)):
        time_s = step * step_s
        travelled_m += speed_mps(time_s) * step_s
        if travelled_m >= (edges + 1) * pitch_m:
            shown_mps, edge_s, edges = pitch_m / max(time_s - edge_s, step_s), time_s, edges + 1
        if step % 20 == 0:
            yield time_s, shown_mps
