"""How the variables of an FMU are called, and how it is stepped."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta, field

from plant_emulator.bounds import Finite, Table


class FmuTable(Table, frozen=True):
    """The unit's side of an FMU car.

    ``names`` gives the unit's own name of a variable whose name here it does not
    share; ``start`` holds parameters that are set before it is initialised.
    """

    step_s: Annotated[float, Meta(ge=1e-5, le=0.01)] = 0.001
    names: dict[str, str] = field(default_factory=dict)
    start: dict[str, Finite] = field(default_factory=dict)
