"""The last seconds, as many points as a plot has columns of dots."""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

from tcs_hil.hil.monitor.snapshot import Side

BIN_NS = 100_000_000
SPAN = 120
"""Bins kept: twelve seconds."""


class Point(NamedTuple):
    """Greatest slips and newest torques of one bin."""

    bin: int
    slip: tuple[float, float]
    reference: float | None
    request_nm: float
    allowed_nm: tuple[float, float]


class History:
    """Points by bins of 0.1 s, oldest first; a peak between two drawings is not lost."""

    def __init__(self) -> None:
        self.points: deque[Point] = deque(maxlen=SPAN)

    def add(self, now_ns: int, left: Side, right: Side, reference: float | None) -> None:
        """Take an instant into its bin; time that goes back begins a new history."""
        point = Point(
            now_ns // BIN_NS,
            (left.slip_ratio, right.slip_ratio),
            reference,
            max(left.request_nm, right.request_nm),
            (left.allowed_nm, right.allowed_nm),
        )
        if self.points and point.bin < self.points[-1].bin:
            self.points.clear()
        if self.points and point.bin == self.points[-1].bin:
            earlier = self.points.pop().slip
            greater = (max(earlier[0], point.slip[0]), max(earlier[1], point.slip[1]))
            point = point._replace(slip=greater)
        self.points.append(point)
