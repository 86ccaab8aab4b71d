"""A limit, ready to be measured: some quantity of a run, compared with a number."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from plant_emulator.expect import Op
from tcs_hil.hil.judging.evidence import Evidence, Series
from tcs_hil.hil.judging.measured import Measured

Measurement = Callable[[Evidence, float, float], Measured]
"""From a run and a window, in seconds, to a value."""

COMPARE: dict[Op, Callable[..., bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
    "==": operator.eq,
    "!=": operator.ne,
}


@dataclass(frozen=True, slots=True)
class Quantity:
    """Something that can be measured; ``clocked`` says that it takes a run in real time."""

    name: str
    unit: str
    measure: Measurement
    labels: Mapping[str, float] = field(default_factory=dict)
    clocked: bool = False

    def written(self, value: float) -> str:
        """A value by its label, or with its unit."""
        for label, number in self.labels.items():
            if number == value:
                return label
        digits = f"{value:.0f}" if 1e3 <= abs(value) < math.inf else f"{value:.4g}"
        return f"{digits} {self.unit}".rstrip()


@dataclass(frozen=True, slots=True)
class Check:
    """A quantity, what it must compare to, and when."""

    quantity: Quantity
    op: Op
    limit: float
    from_s: float = 0.0
    to_s: float = math.inf

    @property
    def text(self) -> str:
        """The limit in words."""
        window = f", from {self.from_s:g} s" if self.from_s else ""
        if self.to_s < math.inf:
            window = f", {self.from_s:g} to {self.to_s:g} s"
        return f"{self.quantity.name} {self.op} {self.quantity.written(self.limit)}{window}"

    def measured(self, evidence: Evidence) -> Measured:
        """Measure it on a run.

        Raises:
            CannotJudgeError: the run holds nothing that could tell.
        """
        return self.quantity.measure(evidence, self.from_s, self.to_s)

    def kept(self, value: float) -> bool:
        """Whether a measured value keeps the limit; NaN keeps none."""
        return not math.isnan(value) and COMPARE[self.op](value, self.limit)


def worst_sample(samples: Series, op: Op, limit: float) -> Measured:
    """The sample farthest beyond the limit, or nearest to it if none is; a NaN before all."""
    values = samples.values
    unknown = np.isnan(values)
    if unknown.any():
        return Measured(math.nan, float(samples.time_s[np.argmax(unknown)]), "not a number")
    worst = int(np.argmax(_badness(values, op, limit)))
    note = _outside(samples, ~np.asarray(COMPARE[op](values, limit)))
    return Measured(float(values[worst]), float(samples.time_s[worst]), note)


def _badness(values: NDArray[np.float64], op: Op, limit: float) -> NDArray[np.float64]:
    if op in ("==", "!="):
        distance = np.abs(values - limit)
        return distance if op == "==" else -distance
    return values if op in ("<", "<=") else -values


def _outside(samples: Series, outside: NDArray[np.bool_]) -> str:
    """When and for how long the limit was broken; a sample holds until the next one."""
    if not outside.any():
        return ""
    held_s = np.diff(samples.time_s, append=samples.time_s[-1])
    first_s = float(samples.time_s[np.argmax(outside)])
    return f"first at {first_s:.3f} s, {1e3 * float(held_s[outside].sum()):.0f} ms in all"
