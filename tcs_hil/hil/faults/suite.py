"""The campaign as a suite: every cell in both manoeuvres under every law."""

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
LAWS: tuple[ControllerName, ...] = ("kmpc", "nmpc", "pi")
SPARE_S = 0.1
"""Driven beyond what the way back may take."""


def fault_cells() -> list[Cell]:
    """Every row of the table."""
    return [*value_cells(), *frame_cells()]


def fault_cases(config: ServiceConfig) -> list[Case]:
    """Every cell of the campaign against the service that ``config`` describes."""
    rounds = product(fault_cells(), MANOEUVRES, LAWS)
    return [fault_case(cell, manoeuvre, law, config) for cell, manoeuvre, law in rounds]


def fault_case(cell: Cell, manoeuvre: str, law: ControllerName, config: ServiceConfig) -> Case:
    """One cell of one manoeuvre under one law."""
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
