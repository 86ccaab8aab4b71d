"""A study's TOML file: which scenario, what varies and how, and what counts as success."""

from __future__ import annotations

import hashlib
from itertools import combinations
from pathlib import Path
from typing import Annotated, Literal

import msgspec
from msgspec import Meta
from msgspec.structs import replace

from plant_emulator.scenario import Scenario, Variant, load_scenario
from tcs_hil.config import read_toml
from tcs_hil.service.settings import ServiceConfig

Number = float | int
Value = float | int | str | bool
Design = Literal["latin-hypercube", "random", "grid"]


class Axis(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What varies: a ``key`` of the scenario, or with ``service.`` in front of the service.

    ``vehicle.body.mass_kg``, ``road.0.mu`` and ``service.control.slip_reference``
    are keys.  From ``low`` to ``high`` (whole numbers if both are), or one of
    ``values``.  A grid takes ``steps`` of a range.
    """

    key: str
    low: Number | None = None
    high: Number | None = None
    values: tuple[Value, ...] = ()
    steps: Annotated[int, Meta(ge=2, le=1000)] = 5

    def __post_init__(self) -> None:
        """Refuse an axis without values, or with them given twice."""
        if (self.low is None) != (self.high is None) or (self.low is None) == (not self.values):
            raise ValueError(f"`{self.key}`: give either `low` and `high` or `values`")
        if self.low is not None and self.high is not None and self.low >= self.high:
            raise ValueError(f"`{self.key}`: `low` must be less than `high`")


class Success(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What a good run keeps to; a limit that is not given is not asked for."""

    limit_cycle: bool = False
    spin_s: Annotated[float, Meta(ge=0.0)] | None = 0.2
    rmse_ratio: Annotated[float, Meta(gt=0.0)] | None = None
    peak_slip_ratio: Annotated[float, Meta(gt=0.0)] | None = None
    gain_ratio: Annotated[float, Meta(gt=0.0)] | None = None


class Study(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Everything about a study; ``scenario`` is a shipped one or a file.

    Paths in it are relative to the study's file.

    ``vehicle`` drives it with this car instead of its own.
    """

    scenario: str
    vehicle: Variant | None = None
    vary: Annotated[tuple[Axis, ...], Meta(min_length=1, max_length=50)]
    description: str = ""
    design: Design = "latin-hypercube"
    points: Annotated[int, Meta(ge=1, le=1_000_000)] = 100
    seed: Annotated[int, Meta(ge=0, lt=2**32)] = 0
    service: ServiceConfig = ServiceConfig()
    success: Success = Success()

    def __post_init__(self) -> None:
        """Refuse two axes for one key."""
        if any(first.key == second.key for first, second in combinations(self.vary, 2)):
            raise ValueError("each `key` may vary once")


class Plan(msgspec.Struct, frozen=True):
    """A study with its scenario read."""

    study: Study
    scenario: Scenario

    @property
    def digest(self) -> str:
        """Tells whether results belong to this plan."""
        return hashlib.sha256(msgspec.json.encode(self)).hexdigest()[:16]


def read_plan(path: Path) -> Plan:
    """Read a study and the scenario it varies.

    Raises:
        ConfigError: a file is missing or wrong; file and key are named.
    """
    study = read_toml(path, Study)
    study = replace(study, service=study.service.beside(path.parent))
    scenario = load_scenario(study.scenario, path.parent)
    if study.vehicle is not None:
        scenario = scenario.with_variant(study.vehicle)
    return Plan(study, scenario.resolved())
