"""Points of the space: Latin hypercube, random or grid; index and seed tell a point."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product

import numpy as np
from scipy.stats import qmc

from tcs_hil.errors import ConfigError
from tcs_hil.hil.study.plan import Axis, Study, Value

Point = tuple[Value, ...]  # a value for every axis, in their order

MOST_POINTS = 1_000_000


def points(study: Study) -> list[Point]:
    """Every point of the study, in the order of their index.

    Raises:
        ConfigError: a grid has more than a million points.
    """
    if study.design == "grid":
        return list(_grid(study.vary))
    if study.design == "random":
        shares = np.random.default_rng(study.seed).random((study.points, len(study.vary)))
    else:
        cube = qmc.LatinHypercube(len(study.vary), rng=np.random.default_rng(study.seed))
        shares = cube.random(study.points)
    return [
        tuple(_at(axis, float(share)) for axis, share in zip(study.vary, row, strict=True))
        for row in shares
    ]


def corners(study: Study) -> list[Point]:
    """The point where every axis begins and the one where every axis ends."""
    return [tuple(_at(axis, share) for axis in study.vary) for share in (0.0, 1.0)]


def _grid(axes: tuple[Axis, ...]) -> Iterator[Point]:
    sides = [_steps(axis) for axis in axes]
    count = math.prod(map(len, sides))
    if count > MOST_POINTS:
        raise ConfigError(f"the grid has {count} points, more than {MOST_POINTS}")
    return product(*sides)


def _steps(axis: Axis) -> list[Value]:
    if axis.values:
        return list(axis.values)
    # Whole numbers may be fewer than the steps: each is taken once.
    return list(dict.fromkeys(_at(axis, step / (axis.steps - 1)) for step in range(axis.steps)))


def _at(axis: Axis, share: float) -> Value:
    """The value a share of the way along the axis, 0 to 1."""
    if axis.values:
        return axis.values[min(int(share * len(axis.values)), len(axis.values) - 1)]
    low, high = axis.low or 0, axis.high or 0
    if isinstance(low, int) and isinstance(high, int):
        return min(low + int(share * (high - low + 1)), high)
    return float(low + share * (high - low))
