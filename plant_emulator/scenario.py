"""A scenario: one TOML file that says everything about a run, checked when it is read."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from plant_emulator.body import Body
from plant_emulator.bounds import Positive, Table
from plant_emulator.bustiming import IDEAL, BusTiming
from plant_emulator.driveline import Driveline
from plant_emulator.driver import Driver
from plant_emulator.expect import ControllerTable, Expect
from plant_emulator.faults import Fault
from plant_emulator.fmu_settings import FmuTable
from plant_emulator.quarter_car import QuarterCar
from plant_emulator.road import Patch
from plant_emulator.road_file import read_road
from plant_emulator.sensors import Sensors
from plant_emulator.tir import read_tir
from plant_emulator.tyre import Tyre
from plant_emulator.whole_car import WholeCar
from tcs_hil.config import FilePath, read_toml
from tcs_hil.errors import ConfigError, offer

MOST_DOUBLINGS = 4
"""Each doubles what those before it leave."""

LIBRARY = Path(__file__).parent / "scenarios"

Variant = Literal["quarter-car", "vehicle", "own"]


class VehicleTable(Table, frozen=True):
    """Which car, and where it differs from the default one.

    ``tyre_file`` is a tyre property file (.tir), relative to the scenario's; it
    takes the place of ``[vehicle.tyre]``.  ``source`` is the file of the variant
    ``own``, relative to the scenario's: ``car.fmu`` or ``car.py:Class``.
    """

    variant: Variant = "vehicle"
    source: FilePath | None = None
    fmu: FmuTable = FmuTable()
    tyre_file: FilePath | None = None
    quarter_car: QuarterCar = QuarterCar()
    body: Body = Body()
    tyre: Tyre = Tyre()
    driveline: Driveline = Driveline()

    def __post_init__(self) -> None:
        """Refuse a car of one's own that is not said where to find, or is found and not driven."""
        if self.variant == "own" and self.source is None:
            raise ValueError('`variant = "own"` needs the file of the car as `source`')
        if self.variant != "own" and self.source is not None:
            raise ValueError(f'`source` is for `variant = "own"`, not "{self.variant}"')

    @property
    def whole(self) -> WholeCar:
        """Parameters of the whole car."""
        return WholeCar(body=self.body, tyre=self.tyre, driveline=self.driveline)


class Scenario(Table, frozen=True):
    """Everything about one run; it ends at ``duration_s`` or at ``end_distance_m``.

    ``road_file`` is a CSV file of patches, relative to the scenario's; it takes the
    place of ``[[road]]``.
    """

    description: str
    driver: Driver
    duration_s: Annotated[float, Meta(gt=0.0, le=86_400.0)]
    end_distance_m: Positive | None = None
    start_speed_kmph: Annotated[float, Meta(ge=0.0, le=200.0)] = 0.0
    vehicle: VehicleTable = VehicleTable()
    road_file: FilePath | None = None
    road: Annotated[tuple[Patch, ...], Meta(min_length=1)] = (Patch(mu=1.0),)
    sensors: Sensors = Sensors()
    bus: BusTiming = BusTiming()
    fault: tuple[Fault, ...] = ()
    controller: ControllerTable = ControllerTable()
    expect: tuple[Expect, ...] = ()

    def __post_init__(self) -> None:
        """Refuse a road whose patches are not in the order of travel."""
        if any(later.from_m <= earlier.from_m for earlier, later in pairwise(self.road)):
            raise ValueError("`from_m` must increase from one `[[road]]` patch to the next")
        doubled = Counter(fault.target for fault in self.fault if fault.kind == "duplicated")
        if max(doubled.values(), default=0) > MOST_DOUBLINGS:
            raise ValueError(f"at most {MOST_DOUBLINGS} faults may make one message `duplicated`")

    @property
    def bus_timing(self) -> BusTiming:
        """Timing of the bus in this run: the quarter car's world knows no delay."""
        return IDEAL if self.vehicle.variant == "quarter-car" else self.bus

    @property
    def start_speed_mps(self) -> float:
        """Speed at the start, all wheels rolling freely."""
        return self.start_speed_kmph / 3.6

    def with_variant(self, variant: Variant) -> Scenario:
        """The same scenario driven by the other car."""
        source = self.vehicle.source if variant == "own" else None
        vehicle = msgspec.structs.replace(self.vehicle, variant=variant, source=source)
        return msgspec.structs.replace(self, vehicle=vehicle)

    def resolved(self) -> Scenario:
        """The same scenario without the files that were read into it: it stands alone."""
        vehicle = msgspec.structs.replace(self.vehicle, tyre_file=None)
        return msgspec.structs.replace(self, vehicle=vehicle, road_file=None)


class Listing(msgspec.Struct, frozen=True):
    """A shipped scenario: its suite is the folder it lies in."""

    name: str
    suite: str
    description: str


def load_scenario(name_or_path: str | Path, folder: Path = Path()) -> Scenario:
    """Read a shipped scenario by name, or any file by its path, relative to ``folder``.

    Raises:
        ConfigError: there is no such scenario or file, it is not TOML, or a key
            is unknown or out of bounds; file and key are named.
    """
    path = _find(name_or_path, folder)
    scenario = read_toml(path, Scenario)
    if scenario.vehicle.tyre_file is not None:
        tyre = read_tir(path.parent / scenario.vehicle.tyre_file)
        vehicle = msgspec.structs.replace(scenario.vehicle, tyre=tyre)
        scenario = msgspec.structs.replace(scenario, vehicle=vehicle)
    if scenario.vehicle.source is not None:
        source = str((path.parent / scenario.vehicle.source).absolute())
        if not _file_of_car(source).is_file():
            what = "is no .fmu and no file.py:Class that exists"
            raise ConfigError(f"{path}: vehicle.source: {source} {what}")
        vehicle = msgspec.structs.replace(scenario.vehicle, source=source)
        scenario = msgspec.structs.replace(scenario, vehicle=vehicle)
    if scenario.road_file is not None:
        road = read_road(path.parent / scenario.road_file)
        scenario = msgspec.structs.replace(scenario, road=road)
    return scenario


def list_scenarios() -> list[Listing]:
    """Every shipped scenario, by suite and name."""
    return [
        Listing(path.stem, path.parent.name, read_toml(path, Scenario).description)
        for path in sorted(LIBRARY.glob("*/*.toml"))
    ]


def _find(name_or_path: str | Path, folder: Path) -> Path:
    path = Path(name_or_path)
    if path.suffix == ".toml" or len(path.parts) > 1:
        return folder / path
    shipped = {path.stem: path for path in LIBRARY.glob("*/*.toml")}
    if str(path) not in shipped:
        name = str(name_or_path)[:100]
        hint = offer(name, shipped) or "; `plant-emulator list` names those"
        raise ConfigError(
            f"scenario {name!r} is neither a .toml file nor one that is shipped{hint}"
        )
    return shipped[str(path)]


def _file_of_car(source: str) -> Path:
    """The file that ``source`` of ``[vehicle]`` names: ``car.fmu``, or ``car.py`` of a class."""
    return Path(source if source.endswith(".fmu") else source.rpartition(":")[0])
