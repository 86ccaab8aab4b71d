"""The driver as a scenario describes it: torque asked of each front motor, by points in time."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated

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
