"""Metrics of one signal over a window, in the signal's unit or in seconds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tcs_hil.hil.judging.evidence import Series
from tcs_hil.hil.judging.measured import Measured

LOW, HIGH = 0.1, 0.9
"""Shares of the way to the target between which a rise is timed."""


class Aim(NamedTuple):
    """What a signal should reach; NaN where the metric needs none.

    ``exact`` for a labelled value, such as a state, which cannot be crossed.
    """

    target: float = np.nan
    band: float = np.nan
    exact: bool = False


@dataclass(frozen=True, slots=True)
class SignalMetric:
    """How to measure; ``unit`` None is the signal's own, with ``per_second`` if a rate."""

    measure: Callable[[Series, Aim], Measured]
    about: str
    unit: str | None = None
    per_second: bool = False
    needs: frozenset[str] = field(default_factory=frozenset)

    def unit_for(self, unit: str) -> str:
        """Unit of the metric of a signal in ``unit``."""
        if self.unit is not None:
            return self.unit
        return f"{unit or '1'}/s" if self.per_second else unit


def _peak(series: Series, _aim: Aim) -> Measured:
    return _at(series, int(np.argmax(series.values)))


def _lowest(series: Series, _aim: Aim) -> Measured:
    return _at(series, int(np.argmin(series.values)))


def _mean(series: Series, _aim: Aim) -> Measured:
    return Measured(float(series.values.mean()))


def _final(series: Series, _aim: Aim) -> Measured:
    return _at(series, -1)


def _rmse(series: Series, aim: Aim) -> Measured:
    return Measured(float(np.sqrt(np.mean((series.values - aim.target) ** 2))))


def _mean_rate(series: Series, _aim: Aim) -> Measured:
    travelled = float(np.abs(np.diff(series.values)).sum())
    return Measured(travelled / max(float(series.time_s[-1] - series.time_s[0]), 1e-9))


def _overshoot(series: Series, aim: Aim) -> Measured:
    """How far beyond the target, seen from where the window begins."""
    beyond = (series.values - aim.target) * _direction(series, aim)
    worst = int(np.argmax(beyond))
    return Measured(max(float(beyond[worst]), 0.0), float(series.time_s[worst]))


def _rise_time(series: Series, aim: Aim) -> Measured:
    """From the first passing of 10 % of the way to the target to the first of 90 %."""
    way = (series.values - series.values[0]) * _direction(series, aim)
    length = abs(aim.target - series.values[0])
    low, high = (_first(series, way >= share * length) for share in (LOW, HIGH))
    if low is None or high is None:
        return Measured(np.inf, None, "never reached")
    return Measured(high - low, high)


def _settling_time(series: Series, aim: Aim) -> Measured:
    """From the window's begin until the signal stays within the band."""
    outside = np.flatnonzero(~_within(series, aim))
    if outside.size == 0:
        return Measured(0.0, float(series.time_s[0]))
    if outside[-1] == len(series.values) - 1:
        return Measured(np.inf, None, "outside the band at the end")
    settled_s = float(series.time_s[outside[-1] + 1])
    return Measured(settled_s - float(series.time_s[0]), settled_s)


def _time_in_range(series: Series, aim: Aim) -> Measured:
    """A sample holds until the next one."""
    held_s = np.diff(series.time_s, append=series.time_s[-1])
    return Measured(float(held_s[_within(series, aim)].sum()))


def _time_to_reach(series: Series, aim: Aim) -> Measured:
    """From the window's begin until the signal is at the target or has crossed it."""
    crossed = (series.values - aim.target) * _direction(series, aim) >= 0.0
    at_s = _first(series, series.values == aim.target if aim.exact else crossed)
    if at_s is None:
        return Measured(np.inf, None, "never reached")
    return Measured(at_s - float(series.time_s[0]), at_s)


def _time_at(series: Series, aim: Aim) -> Measured:
    """How long the signal is exactly the target, such as a state; a sample holds until the next."""
    held_s = np.diff(series.time_s, append=series.time_s[-1])
    there = series.values == aim.target
    return Measured(float(held_s[there].sum()), _first(series, there))


def _within(series: Series, aim: Aim) -> NDArray[np.bool_]:
    return np.asarray(np.abs(series.values - aim.target) <= aim.band)


def _direction(series: Series, aim: Aim) -> float:
    return 1.0 if series.values[0] <= aim.target else -1.0


def _first(series: Series, where: NDArray[np.bool_]) -> float | None:
    return float(series.time_s[np.argmax(where)]) if where.any() else None


def _at(series: Series, index: int) -> Measured:
    return Measured(float(series.values[index]), float(series.time_s[index]))


TARGET = frozenset({"target"})
TARGET_AND_BAND = frozenset({"target", "band"})

SIGNAL_METRICS = {
    "peak": SignalMetric(_peak, "largest value"),
    "lowest": SignalMetric(_lowest, "smallest value"),
    "mean": SignalMetric(_mean, "mean of the samples"),
    "final": SignalMetric(_final, "last value"),
    "RMSE": SignalMetric(_rmse, "root mean square distance from the target", needs=TARGET),
    "mean rate": SignalMetric(_mean_rate, "mean of |d/dt|", per_second=True),
    "overshoot": SignalMetric(_overshoot, "farthest beyond the target", needs=TARGET),
    "rise time": SignalMetric(
        _rise_time, "from 10 % to 90 % of the way to the target", "s", needs=TARGET
    ),
    "settling time": SignalMetric(
        _settling_time, "until it stays within target ± band", "s", needs=TARGET_AND_BAND
    ),
    "time in range": SignalMetric(
        _time_in_range, "time within target ± band", "s", needs=TARGET_AND_BAND
    ),
    "time to reach": SignalMetric(
        _time_to_reach, "until it reaches or crosses the target", "s", needs=TARGET
    ),
    "time at": SignalMetric(_time_at, "time at exactly the target", "s", needs=TARGET),
}
