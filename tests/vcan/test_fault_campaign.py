"""A slice of the fault campaign on a real SocketCAN: the same properties, the same times."""

from pathlib import Path

import pytest

from tcs_hil.hil.faults.suite import family_cases
from tcs_hil.hil.judging.verdict import Verdict
from tcs_hil.hil.suite.case import Case
from tcs_hil.hil.suite.runner import Bench, run_case
from tcs_hil.service.settings import ServiceConfig

from .conftest import CHANNEL

CASES = family_cases(ServiceConfig())
"""`python -m benchmarks.faults --channel vcan0` drives all; here, some with both laws in turn."""


@pytest.mark.parametrize("case", CASES[::9], ids=lambda case: case.name)
def test_a_fault_is_answered_as_on_the_embedded_bus(case: Case, tmp_path: Path) -> None:
    result = run_case(case, Bench("lockstep", tmp_path, "socketcan", CHANNEL))
    assert result.verdict is Verdict.PASSED, result.reason


@pytest.mark.simulated_time
@pytest.mark.parametrize("case", CASES[::27], ids=lambda case: case.name)
def test_it_is_answered_as_well_at_real_pace(case: Case, tmp_path: Path) -> None:
    result = run_case(case, Bench("real-time", tmp_path, "socketcan", CHANNEL))
    assert result.verdict is Verdict.PASSED, result.reason
