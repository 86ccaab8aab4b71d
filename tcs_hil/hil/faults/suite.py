"""The campaign as suites: every cell in both manoeuvres under every law, and one of each family."""

from __future__ import annotations

from itertools import product

from msgspec import structs

from tcs_hil.hil.faults.cell import Cell
from tcs_hil.hil.faults.frames import frame_cells
from tcs_hil.hil.faults.judge import CellJudge
from tcs_hil.hil.faults.manoeuvres import MANOEUVRES
from tcs_hil.hil.faults.values import value_cells
from tcs_hil.hil.suite.case import Case
from tcs_hil.service.settings import ControllerName, ServiceConfig

SUITE = "faults"
FAMILIES = "fault-families"
LAWS: tuple[ControllerName, ...] = ("kmpc", "nmpc", "pi")
FAMILY_LAWS: tuple[ControllerName, ...] = ("kmpc", "nmpc")
FAMILY_MANOEUVRE = "manoeuvre-2"
SPARE_S = 0.1
"""Driven beyond what the way back may take."""


def fault_cells() -> list[Cell]:
    """Every row of the table."""
    return [*value_cells(), *frame_cells()]


def fault_cases(config: ServiceConfig) -> list[Case]:
    """Every cell of the campaign against the service that ``config`` describes."""
    rounds = product(fault_cells(), MANOEUVRES, LAWS)
    return [fault_case(cell, manoeuvre, law, config) for cell, manoeuvre, law in rounds]


def family_cells() -> list[Cell]:
    """One cell of every family, on another target each time; one that must be found, if any."""
    families: dict[str, list[Cell]] = {}
    for cell in fault_cells():
        families.setdefault(cell.family, []).append(cell)
    return [_one_of(family, number) for number, family in enumerate(families.values())]


def family_cases(config: ServiceConfig) -> list[Case]:
    """The campaign in small, for a bus on which runs are slow."""
    rounds = product(family_cells(), FAMILY_LAWS)
    return [fault_case(cell, FAMILY_MANOEUVRE, law, config) for cell, law in rounds]


def _one_of(family: list[Cell], number: int) -> Cell:
    owed = [cell for cell in family if cell.promise.within_s is not None] or family
    return owed[number % len(owed)]


def fault_case(cell: Cell, manoeuvre: str, law: ControllerName, config: ServiceConfig) -> Case:
    """One cell of one manoeuvre under one law."""
    cell = cell.in_manoeuvre(manoeuvre)
    base = MANOEUVRES[manoeuvre]
    scenario = structs.replace(
        base,
        description=f"{' and '.join(cell.targets)}: {cell.family}; {base.description}",
        duration_s=cell.end_s + cell.promise.back_s + SPARE_S,
        fault=cell.faults,
    )
    name = f"{cell.name}/{manoeuvre}"
    config = structs.replace(config, controller=law)
    return Case(SUITE, name, scenario, config, CellJudge(cell))
