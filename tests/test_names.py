"""Units and wheels in the names of quantities."""

from __future__ import annotations

import pytest

from plant_emulator.truth import TRUTH_COLUMNS
from tcs_hil.names import NO_UNIT, column_names, unit_of


@pytest.mark.parametrize(
    ("name", "shape", "columns"),
    [
        ("speed_mps", (), ("speed_mps",)),
        ("limit_nm", (2,), ("limit_fl_nm", "limit_fr_nm")),
        ("slip_ratio", (2,), ("slip_ratio_fl", "slip_ratio_fr")),
        ("mu", (4,), ("mu_fl", "mu_fr", "mu_rl", "mu_rr")),
    ],
)
def test_the_wheel_stands_before_the_unit(
    name: str, shape: tuple[int, ...], columns: tuple[str, ...]
) -> None:
    assert column_names(name, shape) == columns


def test_a_name_that_ends_in_no_unit_has_none() -> None:
    assert unit_of("motor_speed_fl_radps") == "rad/s"
    assert unit_of("slip_ratio_fl") == unit_of("mu") == NO_UNIT


def test_the_plant_fills_every_column_of_its_truth_once() -> None:
    assert sorted(TRUTH_COLUMNS.values()) == list(range(len(TRUTH_COLUMNS)))
    assert {"slip_ratio_fl", "motor_torque_fr_nm", "mu_rr", "held"} <= TRUTH_COLUMNS.keys()
