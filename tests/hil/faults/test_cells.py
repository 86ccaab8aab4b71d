"""The campaign leaves nothing out that the emulator can break."""

from __future__ import annotations

from itertools import pairwise

import pytest

from plant_emulator import faults
from tcs_hil.hil.faults.cell import Cell
from tcs_hil.hil.faults.manoeuvres import MANOEUVRES
from tcs_hil.hil.faults.suite import (
    FAMILY_LAWS,
    LAWS,
    family_cases,
    family_cells,
    fault_cases,
    fault_cells,
)
from tcs_hil.hil.suite.case import check_cases, distinct, with_law
from tcs_hil.hil.suite.library import suite_cases
from tcs_hil.service.settings import ServiceConfig

CELLS = fault_cells()
CONFIG = ServiceConfig()

SORTS = {
    "front wheel": faults.WHEELS[:2],
    "rear wheel": faults.WHEELS[2:],
    "motor speed": ("MotorSpeedL", "MotorSpeedR"),
    "motor torque": ("MotorTorqueL", "MotorTorqueR"),
    "request": ("DriverTorqueRequestL", "DriverTorqueRequestR"),
    "limit": faults.LIMITS,
    "motor": faults.MOTORS,
}
EACH = ("VehicleAccelX", *faults.MESSAGES, *faults.UNPROTECTED, *faults.NODES)
"""Left and right are of one sort; everything else is the only one of its sort."""


def kinds_tried(targets: tuple[str, ...]) -> set[str]:
    return {cell.kind for cell in CELLS if set(cell.targets) & set(targets)}


def kinds_possible(target: str) -> set[str]:
    return set(faults._KINDS_OF[target])  # what a scenario may ask for


@pytest.mark.parametrize("targets", [*SORTS.values(), *((each,) for each in EACH)])
def test_every_kind_of_fault_is_tried_on_every_sort_of_target(targets: tuple[str, ...]) -> None:
    assert kinds_tried(targets) == kinds_possible(targets[0])


def test_every_target_of_the_emulator_is_of_a_sort_that_is_tried() -> None:
    sorted_out = {target for sort in SORTS.values() for target in sort} | set(EACH)
    assert sorted_out == set(faults._KINDS_OF)


def test_every_cell_is_driven_in_both_manoeuvres_under_every_law() -> None:
    cases = fault_cases(CONFIG)
    check_cases(cases)
    assert len(cases) == len(CELLS) * len(MANOEUVRES) * len(LAWS)
    assert {case.config.control.preset for case in cases} == {"default"}


def test_the_suite_is_one_that_can_be_asked_for_by_name_and_by_law() -> None:
    cases = suite_cases("faults", CONFIG)
    only = distinct(with_law(case, "pi", None) for case in cases)
    assert len(only) == len(cases) // len(LAWS)


def test_the_small_campaign_has_each_family_once_and_each_kind_of_fault() -> None:
    families = family_cells()
    assert sorted(cell.family for cell in families) == sorted({cell.family for cell in CELLS})
    assert {cell.kind for cell in families} == {cell.kind for cell in CELLS}
    assert len(family_cases(CONFIG)) == len(families) * len(FAMILY_LAWS)


def test_the_small_campaign_takes_what_must_be_found_where_a_family_has_it() -> None:
    owing = {cell.family for cell in CELLS if cell.promise.within_s is not None}
    assert {cell.family for cell in family_cells() if cell.promise.within_s is not None} == owing


def test_the_small_campaign_is_part_of_the_whole_one() -> None:
    whole = {case.name: case for case in suite_cases("faults", CONFIG)}
    assert all(whole[case.name] == case for case in suite_cases("fault-families", CONFIG))


@pytest.mark.parametrize("cell", CELLS, ids=lambda cell: cell.name)
def test_a_cell_either_owes_a_time_or_says_why_not(cell: Cell) -> None:
    promise = cell.promise
    assert (promise.within_s is None) == bool(promise.why)
    assert (promise.within_s is None) == (promise.named_s is None)
    if promise.within_s is not None:
        assert promise.codes
        assert promise.within_s <= cell.lasts_s


def test_what_is_let_go_at_walking_pace_is_owed_where_the_car_is_faster() -> None:
    (cell,) = (each for each in CELLS if each.slow_promise is not None)
    slow, fast = (cell.in_manoeuvre(manoeuvre).promise for manoeuvre in MANOEUVRES)
    assert (slow.within_s, fast.within_s) == (None, 0.1)
    assert slow.codes == fast.codes


def test_names_differ_even_where_the_words_are_alike() -> None:
    names = sorted(cell.name for cell in CELLS)
    assert all(one != other for one, other in pairwise(names))
