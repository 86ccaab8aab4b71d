"""The driver: torque asked of each front motor, straight lines between points in time."""

from __future__ import annotations

from bisect import bisect_right
from itertools import pairwise
from typing import Annotated, NamedTuple

from msgspec import Meta

from plant_emulator.bounds import NonNegative, Table

RequestNm = Annotated[float, Meta(ge=0.0, le=500.0)]


class Driver(Table, frozen=True):
    """Request per front motor as points (s, Nm); before the first and after the last it is held.

    Two points at the same time are a step.
    """

    request: Annotated[tuple[tuple[NonNegative, RequestNm], ...], Meta(min_length=1)]

    def __post_init__(self) -> None:
        """Refuse points that go back in time."""
        if any(later[0] < earlier[0] for earlier, later in pairwise(self.request)):
            raise ValueError("the times of `request` must not decrease")


class Line(NamedTuple):
    """A quantity that changes at a constant rate: its value now and its slope per second."""

    value: float
    slope: float


class Pedal:
    """Reads a driver's points."""

    def __init__(self, driver: Driver) -> None:
        self._points = driver.request
        self._times_s = [time_s for time_s, _ in driver.request]

    def at(self, time_s: float) -> Line:
        """Request from ``time_s`` on, valid until `next_change`."""
        index = bisect_right(self._times_s, time_s)
        if index == 0 or index == len(self._points):
            return Line(self._points[max(index - 1, 0)][1], 0.0)
        (start_s, start_nm), (end_s, end_nm) = self._points[index - 1 : index + 1]
        slope = (end_nm - start_nm) / (end_s - start_s)
        return Line(start_nm + slope * (time_s - start_s), slope)

    def next_change(self, time_s: float) -> float:
        """First point after ``time_s``; infinite after the last."""
        index = bisect_right(self._times_s, time_s)
        return self._times_s[index] if index < len(self._times_s) else float("inf")
