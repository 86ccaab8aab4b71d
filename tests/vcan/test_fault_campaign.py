"""Cells of the fault campaign on a real SocketCAN: the same properties, the same times."""

from pathlib import Path

import pytest

from tcs_hil.hil.faults.suite import fault_case, fault_cells
from tcs_hil.hil.judging.verdict import Verdict
from tcs_hil.hil.suite.runner import Bench, run_case
from tcs_hil.service.settings import ControllerName, ServiceConfig

from .conftest import CHANNEL

CELLS = {cell.name: cell for cell in fault_cells()}


@pytest.mark.parametrize(
    ("cell", "manoeuvre", "law"),
    [
        ("WheelSpeedsRear-dropped", "manoeuvre-2", "kmpc"),
        ("WheelSpeedRL+WheelSpeedRR-off", "manoeuvre-1", "nmpc"),
        ("MotorState-wrong-CRC", "manoeuvre-2", "pi"),
        ("WheelSpeedsFront-twice", "manoeuvre-1", "kmpc"),
        ("VEHICLE-babbling", "manoeuvre-2", "nmpc"),
    ],
)
def test_a_fault_is_answered_as_on_the_embedded_bus(
    cell: str, manoeuvre: str, law: ControllerName, tmp_path: Path
) -> None:
    case = fault_case(CELLS[cell], manoeuvre, law, ServiceConfig())
    result = run_case(case, Bench("lockstep", tmp_path, "socketcan", CHANNEL))
    assert result.verdict is Verdict.PASSED, result.reason
