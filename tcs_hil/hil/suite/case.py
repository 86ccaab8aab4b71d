"""A case: one scenario against one service, and who judges it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from msgspec import structs, to_builtins

from plant_emulator.expect import Expect
from plant_emulator.scenario import Scenario
from plant_emulator.session import check_own_car
from tcs_hil.config import convert
from tcs_hil.control.settings import PresetName
from tcs_hil.errors import ConfigError
from tcs_hil.hil.judging.channels import namespace
from tcs_hil.hil.judging.checks import prepare
from tcs_hil.hil.judging.evidence import Evidence
from tcs_hil.hil.judging.verdict import Finding, judge
from tcs_hil.service.bus_end import bus_end
from tcs_hil.service.settings import ControllerName, ServiceConfig

Judge = Callable[[Evidence], list[Finding]]


ALWAYS = (
    Expect(metric="limit above request", op="<=", value=0.0),
    Expect(metric="lowest limit", op=">=", value=0.0),
    Expect(metric="failed ticks", op="==", value=0.0),
)
"""What holds in every run, whoever wrote the scenario: the service only ever lowers torque."""


def judge_expectations(evidence: Evidence) -> list[Finding]:
    """Judge a run by its scenario's `[[expect]]` tables, and by what always holds."""
    database = evidence.config.bus.database
    expected = (*evidence.scenario.expect, *ALWAYS)
    return judge([prepare(each, database) for each in expected], evidence)


@dataclass(frozen=True, slots=True)
class Case:
    """One run to be made; ``scenario_name`` and the law tell it from the others of its suite.

    ``judge`` must be a function of a module: it is called in another process.
    """

    suite: str
    scenario_name: str
    scenario: Scenario
    config: ServiceConfig
    judge: Judge = judge_expectations

    @property
    def name(self) -> str:
        """Unique in a run of the bench; also where in its folder the run is kept."""
        preset = "" if self.config.control.preset == "default" else f"-{self.config.control.preset}"
        return f"{self.scenario_name}/{self.config.controller}{preset}"


def with_law(case: Case, controller: ControllerName | None, preset: PresetName | None) -> Case:
    """The same case under another control law; None leaves it as it is.

    Raises:
        ConfigError: there is no such law or preset.
    """
    config = case.config
    if controller is not None:
        config = structs.replace(config, controller=controller)
    if preset is not None:
        config = structs.replace(config, control=structs.replace(config.control, preset=preset))
    return replace(case, config=convert(to_builtins(config), ServiceConfig, case.scenario_name))


def distinct(cases: Iterable[Case]) -> list[Case]:
    """Each case once: suites may overlap, or themselves ask for a law that was chosen."""
    kept: list[Case] = []
    named: dict[str, Case] = {}
    for case in cases:
        if named.get(case.name) != case:
            named[case.name] = case
            kept.append(case)
    return kept


def check_cases(cases: Sequence[Case]) -> None:
    """Refuse what could not be driven, judged or told apart, before anything is driven.

    Raises:
        DatabaseError: the DBC cannot be used.
        ConfigError: there is no such model file, a signal map does not fit its DBC, a
            car of one's own cannot be driven, an expectation names what does not
            exist, or two cases have one name; the culprit is named.
    """
    for model in {case.config.model for case in cases} - {None}:
        if not Path(str(model)).is_file():
            raise ConfigError(f"{model}: there is no such model file")
    configs = (case.config for case in cases if case.config.bus.database is not None)
    for config in {(each.bus.database, repr(each.map)): each for each in configs}.values():
        bus_end(config)
    for scenario in {case.scenario_name: case.scenario for case in cases}.values():
        check_own_car(scenario)
    for case in cases:
        namespace(case.config.bus.database)
        for place, expect in enumerate(case.scenario.expect):  # counted as in every TOML error
            try:
                prepare(expect, case.config.bus.database)
            except ConfigError as error:
                raise ConfigError(f"{case.scenario_name}: expect[{place}]: {error}") from error
    twice = _first_twice(case.name for case in cases)
    if twice is not None:
        raise ConfigError(f"two cases are called {twice}: name one of the scenarios differently")


def _first_twice(names: Iterable[str]) -> str | None:
    seen: set[str] = set()
    for name in names:
        if name in seen:
            return name
        seen.add(name)
    return None
