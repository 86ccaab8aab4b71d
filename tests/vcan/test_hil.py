"""The bench on a real SocketCAN: judged as on the embedded bus, and its clock taken seriously."""

from pathlib import Path

import pytest
from msgspec.structs import replace

from plant_emulator.expect import Expect
from tcs_hil.hil.judging.verdict import Verdict
from tcs_hil.hil.run import Mode
from tcs_hil.hil.suite.case import Case, with_law
from tcs_hil.hil.suite.library import scenario_case
from tcs_hil.hil.suite.result import Result
from tcs_hil.hil.suite.runner import Bench, run_case
from tcs_hil.service.settings import ServiceConfig

from .conftest import CHANNEL


def drive(case: Case, mode: Mode, folder: Path) -> Result:
    result = run_case(case, Bench(mode, folder, "socketcan", CHANNEL))
    assert not result.error
    return result


def test_a_shipped_scenario_is_judged_on_a_real_bus(tmp_path: Path) -> None:
    result = drive(scenario_case("manoeuvre-1", ServiceConfig()), "lockstep", tmp_path)
    assert result.verdict is Verdict.PASSED, result.reason
    log = tmp_path / "runs" / result.name / "service.log"
    assert f"bus: socketcan {CHANNEL}" in log.read_text()


def test_a_signal_on_the_bus_is_judged_at_the_time_of_the_plant(tmp_path: Path) -> None:
    case = with_law(scenario_case("manoeuvre-1", ServiceConfig()), "pi", None)
    asked = {"metric": "time to reach", "signal": "DriverTorqueRequestL", "target": 125.0}
    # The ramp is there at 0.35 s; the request is sent every 10 ms.
    expect = tuple(
        Expect(op=op, value=value, **asked) for op, value in (("<", 0.361), (">=", 0.349))
    )
    case = replace_scenario(case, expect)
    assert drive(case, "lockstep", tmp_path).verdict is Verdict.PASSED


@pytest.mark.simulated_time
def test_in_simulated_time_no_tick_is_late(tmp_path: Path) -> None:
    expect = (
        Expect(metric="overruns", op="==", value=0.0),
        Expect(metric="skipped ticks", op="==", value=0.0),
        Expect(metric="latency max", op="<", value=2000.0),
        Expect(signal="bus.TcsState", op="!=", value="FAULT"),
    )
    case = replace_scenario(scenario_case("manoeuvre-1", ServiceConfig()), expect)
    result = drive(case, "real-time", tmp_path)
    assert result.verdict is Verdict.PASSED, result.reason


def replace_scenario(case: Case, expect: tuple[Expect, ...]) -> Case:
    scenario = replace(case.scenario, expect=expect)
    return Case(case.suite, case.scenario_name, scenario, case.config)
