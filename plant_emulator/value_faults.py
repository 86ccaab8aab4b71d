"""What faults do to a value: a signal on its way to the bus, a torque on its way to a motor."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable

import numpy as np

from plant_emulator.faults import Fault

Alteration = Callable[[float, float], float | None]
"""(value, time in s) -> altered value, None where nothing is left of it."""


def alteration(fault: Fault, rng: np.random.Generator) -> Alteration:
    """Make what ``fault`` does to a value while it is active; call it at every sample.

    It is called while inactive, too, and then leaves the value alone: some
    faults remember how things were before.
    """
    makers: dict[str, Callable[[], Alteration]] = {
        "off": lambda: lambda value, time_s: None if fault.active(time_s) else value,
        "intermittent": lambda: lambda value, time_s: None if fault.active(time_s) else value,
        "stuck": lambda: _Stuck(fault),
        "garbage": lambda: _Garbage(fault, rng),
        "wrong": lambda: (
            lambda value, time_s: (
                fault.scale * value + fault.offset if fault.active(time_s) else value
            )
        ),
        "slow": lambda: _Slow(fault),
        "delayed": lambda: _Delayed(fault),
    }
    return makers[fault.kind]()


class _Stuck:
    """Holds the last value from before the fault, or its first one."""

    def __init__(self, fault: Fault) -> None:
        self._fault = fault
        self._held: float | None = None

    def __call__(self, value: float, time_s: float) -> float:
        if self._held is None or not self._fault.active(time_s):
            self._held = value
        return self._held


class _Garbage:
    """Anything between the fault's bounds, anew in every sample."""

    def __init__(self, fault: Fault, rng: np.random.Generator) -> None:
        self._fault = fault
        self._rng = rng

    def __call__(self, value: float, time_s: float) -> float:
        if not self._fault.active(time_s):
            return value
        return float(self._rng.uniform(self._fault.low, self._fault.high))


class _Slow:
    """A first-order lag."""

    def __init__(self, fault: Fault) -> None:
        self._fault = fault
        self._last: tuple[float, float] | None = None  # value, time

    def __call__(self, value: float, time_s: float) -> float:
        if self._last is not None and self._fault.active(time_s):
            before, then_s = self._last
            follow = -np.expm1(-(time_s - then_s) / self._fault.time_constant_s)
            value = before + float(follow) * (value - before)
        self._last = (value, time_s)
        return value


class _Delayed:
    """The value as it was ``delay_s`` ago."""

    def __init__(self, fault: Fault) -> None:
        self._fault = fault
        self._past: deque[tuple[float, float]] = deque()  # time, value

    def __call__(self, value: float, time_s: float) -> float:
        self._past.append((time_s, value))
        then_s = time_s - self._fault.delay_s
        while len(self._past) > 1 and self._past[1][0] <= then_s:
            self._past.popleft()
        return self._past[0][1] if self._fault.active(time_s) else value
