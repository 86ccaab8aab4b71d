"""Finding limit cycles: oscillations that the loop keeps up by itself."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tcs_hil.hil.metrics.truth import Truth

LEAST_SWINGS = 8
LEAST_SPAN_S = 0.4
"""Four periods of the slow ones and 0.4 s of the fast ones: what rings down is quiet by then."""
SLOWEST_SWING_S = 0.25
LEAST_SWING = {"slip_ratio": 0.05, "motor_torque_nm": 25.0}
"""Half the slip reference, a tenth of the motor's torque: above what a toothed sensor stirs up."""
SUSTAINED_RATIO = 0.7


@dataclass(frozen=True, slots=True)
class LimitCycle:
    """Where a run first oscillates.

    ``signal`` is ``slip_ratio`` or ``motor_torque_nm``, ``side`` 0 on the left,
    ``swing`` the mean from peak to peak.
    """

    signal: str
    side: int
    start_s: float
    frequency_hz: float
    swing: float


def find_limit_cycle(truth: Truth) -> LimitCycle | None:
    """Return the earliest limit cycle of a driven wheel's true slip or its motor's torque, if any.

    A limit cycle is an unbroken row of swings, at least eight of them and at
    least 0.4 s long, in which each swing

    - is at least 0.05 of slip or 25 Nm of motor torque from peak to peak, taken
      between turning points, so that smaller ripple neither counts nor hides it;
    - takes at most 0.25 s, so the loop oscillates at 2 Hz or faster;
    - happens on the same friction: where mu changes under the wheel the count
      starts anew, and no jump or chequered road passes for a fault of the loop;

    and which does not die away: the swings of its second half are on average at
    least 0.7 of those of its first.  Eight swings that decay with a damping ratio
    of 0.03 just miss that.
    """
    cycles = (cycle for name in LEAST_SWING for side in (0, 1) for cycle in _of(truth, name, side))
    return min(cycles, key=lambda cycle: cycle.start_s, default=None)


def turning_points(values: NDArray[np.float64], least: float) -> list[int]:
    """Indices at which ``values`` turn, alternately high and low, ``least`` or more apart."""
    found: list[int] = []
    sign, extreme = 1.0, 0
    for index in range(1, len(values)):
        beyond = sign * (values[index] - values[extreme])
        if beyond > 0.0:
            extreme = index
        elif -beyond >= least:
            found.append(extreme)
            sign, extreme = -sign, index
    return found


def _of(truth: Truth, signal: str, side: int) -> Iterator[LimitCycle]:
    """The first limit cycle of one signal on each stretch of constant friction."""
    changes = np.flatnonzero(np.diff(truth["mu"][:, side])) + 1
    for stretch in np.split(truth, changes):
        turns = turning_points(stretch[signal][:, side], LEAST_SWING[signal])
        turned = stretch[turns]
        times_s, values = turned["time_s"], turned[signal][:, side]
        row = _first_sustained(times_s, values)
        if row is not None:
            yield _described(signal, side, times_s[row], values[row])


def _described(
    signal: str, side: int, times_s: NDArray[np.float64], values: NDArray[np.float64]
) -> LimitCycle:
    """A limit cycle by its turning points."""
    swings = np.abs(np.diff(values))
    frequency_hz = 0.5 * len(swings) / (times_s[-1] - times_s[0])
    return LimitCycle(signal, side, float(times_s[0]), float(frequency_hz), float(swings.mean()))


def _first_sustained(times_s: NDArray[np.float64], values: NDArray[np.float64]) -> slice | None:
    """Turning points of the first row of swings that makes a limit cycle."""
    swings, spans_s = np.abs(np.diff(values)), np.diff(times_s)
    ends = np.searchsorted(times_s, times_s + LEAST_SPAN_S - 1e-9)
    for start, long_enough in enumerate(ends):
        end = max(int(long_enough), start + LEAST_SWINGS)
        if end >= len(times_s):
            return None
        middle = (start + end) // 2
        fast = spans_s[start:end].max() <= SLOWEST_SWING_S
        if fast and swings[middle:end].mean() >= SUSTAINED_RATIO * swings[start:middle].mean():
            return slice(start, end + 1)
    return None
