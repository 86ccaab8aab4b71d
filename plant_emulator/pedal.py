"""What the driver asks for at an instant: straight lines between the points of the scenario."""

from __future__ import annotations

from bisect import bisect_right

from plant_emulator.driver import Driver


class Line:
    """A quantity that changes at a constant rate: its value now and its slope per second."""

    __slots__ = ("slope", "value")

    def __init__(self, value: float, slope: float) -> None:
        self.value = value
        self.slope = slope


class Pedal:
    """Reads a driver's points."""

    __slots__ = ("_points", "_times_s")

    def __init__(self, driver: Driver) -> None:
        self._points = driver.request
        self._times_s = [time_s for time_s, _ in driver.request]

    def at(self, time_s: float) -> Line:
        """Request from ``time_s`` on, valid until `next_change`."""
        index = bisect_right(self._times_s, time_s)
        if index == 0 or index == len(self._points):
            return Line(self._points[max(index - 1, 0)][1], 0.0)
        start_s, start_nm = self._points[index - 1]
        end_s, end_nm = self._points[index]
        slope = (end_nm - start_nm) / (end_s - start_s)
        return Line(start_nm + slope * (time_s - start_s), slope)

    def next_change(self, time_s: float) -> float:
        """First point after ``time_s``; infinite after the last."""
        index = bisect_right(self._times_s, time_s)
        return self._times_s[index] if index < len(self._times_s) else float("inf")
