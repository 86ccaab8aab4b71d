"""The parts of the benchmark, and what a run of some of them leaves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import msgspec

from tcs_hil.hil.bench.bus import BusRow, measure_bus
from tcs_hil.hil.bench.conditions import conditions
from tcs_hil.hil.bench.controllers import ControllerRow, measure_controllers
from tcs_hil.hil.bench.effort import Effort, Progress
from tcs_hil.hil.bench.scaling import ScalingRow, measure_scaling
from tcs_hil.hil.bench.start import StartRow, measure_starts
from tcs_hil.hil.bench.tick import TickRow, measure_ticks

MEASURES = {
    "controllers": measure_controllers,
    "tick": measure_ticks,
    "scaling": measure_scaling,
    "bus": measure_bus,
    "start": measure_starts,
}


class Result(msgspec.Struct, frozen=True):
    """Rows of every part that ran, None for the others."""

    conditions: str
    controllers: list[ControllerRow] | None = None
    tick: list[TickRow] | None = None
    scaling: list[ScalingRow] | None = None
    bus: list[BusRow] | None = None
    start: list[StartRow] | None = None


def measure(parts: Sequence[str], effort: Effort, progress: Progress) -> Result:
    """Run the named parts one after the other.

    Raises:
        TcsError: a program of the bench failed.
    """
    rows: dict[str, Any] = {}
    for done, part in enumerate(parts):

        def advance(share: float, what: str, done: int = done) -> None:
            progress((done + share) / len(parts), what)

        rows[part] = MEASURES[part](effort, advance)
    return Result(conditions(), **rows)
