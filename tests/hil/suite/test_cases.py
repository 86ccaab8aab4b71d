"""Suites, cases and their laws."""

from __future__ import annotations

from pathlib import Path

import pytest
from hil.driven import LAUNCH, launch
from msgspec import structs

from plant_emulator.expect import Expect
from plant_emulator.scenario import VehicleTable, list_scenarios
from tcs_hil.errors import ConfigError, DatabaseError, TcsError
from tcs_hil.hil.suite.case import Case, check_cases, judge_expectations, with_law
from tcs_hil.hil.suite.library import scenario_case, suite_cases, suite_names
from tcs_hil.service.settings import BusSettings, ServiceConfig

CONFIG = ServiceConfig()


def test_the_folders_of_the_library_are_its_suites() -> None:
    assert {"all", "launch", "fault", "paper"} <= set(suite_names())
    assert len(suite_cases("all", CONFIG)) == len(list_scenarios())
    assert {case.suite for case in suite_cases("launch", CONFIG)} == {"launch"}


def test_a_suite_that_does_not_exist_is_refused_with_those_that_do() -> None:
    with pytest.raises(ConfigError, match=r"no suite 'lunch'; did you mean launch\?"):
        suite_cases("lunch", CONFIG)
    with pytest.raises(ConfigError, match=r"no suite 'xyz'; there are all, bus, .*launch"):
        suite_cases("xyz", CONFIG)


def test_every_shipped_scenario_asks_for_something_the_bench_knows() -> None:
    cases = suite_cases("all", CONFIG)
    check_cases(cases)
    assert all(case.scenario.expect for case in cases)


def test_a_scenario_says_which_law_it_is_meant_for() -> None:
    paper = scenario_case("manoeuvre-1", CONFIG)
    assert (paper.config.controller, paper.config.control.preset) == ("nmpc", "paper")
    assert paper.name == "manoeuvre-1/nmpc-paper"
    assert scenario_case("gentle", CONFIG).name == "gentle/nmpc"


def test_the_user_may_choose_another_law() -> None:
    case = with_law(scenario_case("manoeuvre-1", CONFIG), "kmpc", "default")
    assert case.name == "manoeuvre-1/kmpc"


def test_a_limit_on_what_does_not_exist_is_refused_with_scenario_and_place() -> None:
    scenario = structs.replace(
        LAUNCH,
        expect=(
            Expect(metric="peak slip", op="<", value=1.0),
            Expect(signal="truth.slpi_ratio_fl", op="<", value=1.0),
        ),
    )
    with pytest.raises(ConfigError, match=r"^mine: expect\[1\]: there is no signal"):
        check_cases([Case("own", "mine", scenario, CONFIG)])


@pytest.mark.parametrize(
    "config",
    [
        structs.replace(CONFIG, model="nowhere.npz"),
        structs.replace(CONFIG, bus=BusSettings(database="nowhere.dbc")),
    ],
)
def test_a_file_of_the_service_that_is_not_there_is_refused(config: ServiceConfig) -> None:
    with pytest.raises(TcsError, match=r"^nowhere\."):
        check_cases([Case("own", "mine", LAUNCH, config)])


def test_a_dbc_that_lacks_what_the_service_needs_is_refused(tmp_path: Path) -> None:
    (tmp_path / "cut.dbc").write_text('VERSION ""\n\nBU_: TCS\n\nBO_ 144 TorqueLimit: 8 TCS\n')
    config = structs.replace(CONFIG, bus=BusSettings(database=str(tmp_path / "cut.dbc")))
    with pytest.raises(DatabaseError, match=r"cut\.dbc: message TorqueLimit"):
        check_cases([Case("own", "mine", LAUNCH, config)])


def test_a_car_that_cannot_be_driven_is_refused(tmp_path: Path) -> None:
    (tmp_path / "car.py").write_text("class Car:\n    def __init__(self, scenario): pass\n")
    vehicle = VehicleTable(variant="own", source=str(tmp_path / "car.py:Car"))
    with pytest.raises(ConfigError, match=r"car\.py:Car: fails in `advance`"):
        check_cases([Case("own", "mine", structs.replace(LAUNCH, vehicle=vehicle), CONFIG)])


def test_two_scenarios_of_one_name_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="two cases are called gentle/nmpc"):
        check_cases([scenario_case("gentle", CONFIG)] * 2)


def test_that_torque_is_only_ever_lowered_is_asked_of_every_run() -> None:
    limits = [finding.limit for finding in judge_expectations(launch())]
    assert limits == ["limit above request <= 0 Nm", "lowest limit >= 0 Nm", "failed ticks == 0"]
