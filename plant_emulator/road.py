"""The road by travelled distance: friction per side, grade, and what friction does to the tyre."""

from __future__ import annotations

import math
from typing import Annotated, Literal, NamedTuple, TypeAlias

import numpy as np
from msgspec import Meta
from numpy.typing import NDArray

from plant_emulator.bounds import NonNegative, Table
from plant_emulator.compiled import compiled
from plant_emulator.truth import MU, Row

Friction = Annotated[float, Meta(gt=0.0, le=1.5)]
Grade = Annotated[float, Meta(ge=-0.2, le=0.2)]

SHORTEST_S = 1e-10

FROM_M, MU_LEFT, MU_RIGHT, GRADE, PEAK_ONLY = range(5)
PatchRow: TypeAlias = tuple[float, float, float, float, float]


class Patch(Table, frozen=True):
    """Road from ``from_m`` (of the front axle) to the next patch.

    ``grade`` is rise over run, uphill positive.  ``scaling`` says what friction
    does to the tyre's curve: ``shape`` scales all of it (the paper's
    assumption), ``peak`` only the peak, so that the stiffness stays and the
    best slip shrinks with mu.
    """

    from_m: NonNegative = 0.0
    mu: Friction | None = None
    mu_left: Friction | None = None
    mu_right: Friction | None = None
    grade: Grade = 0.0
    scaling: Literal["shape", "peak"] = "shape"

    def __post_init__(self) -> None:
        """Refuse a patch whose friction is not given exactly once per side."""
        sides = (self.mu_left, self.mu_right)
        if (self.mu is None) == (sides == (None, None)) or sides.count(None) == 1:
            raise ValueError("give either `mu` or both `mu_left` and `mu_right`")

    @property
    def row(self) -> PatchRow:
        """The patch as compiled code reads it."""
        left = self.mu if self.mu_left is None else self.mu_left
        right = self.mu if self.mu_right is None else self.mu_right
        return (self.from_m, left or 0.0, right or 0.0, self.grade, float(self.scaling == "peak"))


def road_table(patches: tuple[Patch, ...]) -> NDArray[np.float64]:
    """Return the patches as an array, (patches, 5), columns as named above."""
    return np.array([patch.row for patch in patches])


@compiled
def patch_at(road: NDArray[np.float64], position_m: float) -> int:
    """Row of the patch under ``position_m``; the first one reaches back without end."""
    row = 0
    while row + 1 < road.shape[0] and position_m >= road[row + 1, FROM_M]:
        row += 1
    return row


@compiled
def time_to_edge(
    road: NDArray[np.float64], position_m: float, speed_mps: float, tail_m: float
) -> float:
    """Time until the front axle, or what follows ``tail_m`` behind it, reaches another patch, s.

    At constant speed; infinite if there is none ahead, and never below 0.1 ns, so
    that whoever steps to the edge comes past it.
    """
    nearest_s = math.inf
    if road.shape[0] > 1 and speed_mps != 0.0:
        for axle_m in (position_m, position_m - tail_m):
            row = patch_at(road, axle_m)
            edge = row + 1 if speed_mps > 0.0 else row
            if 0 < edge < road.shape[0]:
                nearest_s = min(nearest_s, (road[edge, FROM_M] - axle_m) / speed_mps)
    return max(nearest_s, SHORTEST_S)


class Site(NamedTuple):
    """The road under the car but for its friction."""

    front_peak_only: bool
    rear_peak_only: bool
    grade_sin: float
    grade_cos: float


@compiled
def site_at(road: NDArray[np.float64], position_m: float, wheelbase_m: float, row: Row) -> Site:
    """Read the road under a car whose front axle is at ``position_m``.

    Friction under each wheel goes into ``row``, the rear ones' a wheelbase
    behind; the grade is the mean of both axles'.
    """
    front = road[patch_at(road, position_m)]
    rear = road[patch_at(road, position_m - wheelbase_m)]
    row[MU], row[MU + 1] = front[MU_LEFT], front[MU_RIGHT]
    row[MU + 2], row[MU + 3] = rear[MU_LEFT], rear[MU_RIGHT]
    rise = 0.5 * (front[GRADE] + rear[GRADE])
    grade_cos = 1.0 / math.sqrt(1.0 + rise * rise)
    return Site(front[PEAK_ONLY] > 0.0, rear[PEAK_ONLY] > 0.0, rise * grade_cos, grade_cos)
