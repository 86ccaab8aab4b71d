"""Plants to measure: scenarios made of a few tables, and runs of them as arrays."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from plant_emulator.plant import Plant
from plant_emulator.scenario import Scenario
from plant_emulator.truth import TRUTH_DTYPE
from tcs_hil.signals import TorqueLimits

Points = Sequence[tuple[float, float]]
Rows = NDArray[np.void]  # (instants,) of TRUTH_DTYPE

VEHICLE_TABLES = ("variant", "body", "tyre", "driveline")


def plant(request: Points, **tables: Any) -> Plant:
    """Make a plant whose driver asks for ``request``; ``tables`` are those of a scenario."""
    document = {"description": "", "duration_s": 600.0, "driver": {"request": request}}
    vehicle = {name: tables.pop(name) for name in VEHICLE_TABLES if name in tables}
    return Plant(msgspec.convert(document | {"vehicle": vehicle} | tables, Scenario))


def drive(
    car: Plant, duration_s: float, dt_s: float = 0.002, limit_nm: float | None = None
) -> Rows:
    """Drive for ``duration_s``, under a constant limit if one is given; one row per ``dt_s``."""
    limits = None if limit_nm is None else TorqueLimits(limit_nm, limit_nm)
    rows = [car.row]
    for _ in range(round(duration_s / dt_s)):
        car.step(limits, dt_s)
        rows.append(car.row)
    return np.array(rows).view(TRUTH_DTYPE)[:, 0]
