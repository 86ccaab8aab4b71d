"""A run as a test handles it: drive it, then say what it should have done."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from msgspec import structs

from plant_emulator.expect import Expect, Op
from tcs_hil.control.settings import PresetName
from tcs_hil.hil.judging.channels import namespace
from tcs_hil.hil.judging.checks import prepare
from tcs_hil.hil.judging.evidence import Evidence, Series
from tcs_hil.hil.judging.of_run import RUN_METRICS
from tcs_hil.hil.judging.verdict import Finding, Verdict, judge
from tcs_hil.hil.run import Mode, RunPlan, execute
from tcs_hil.hil.suite.case import Case, check_cases, with_law
from tcs_hil.hil.suite.library import scenario_case
from tcs_hil.hil.suite.runner import Bench
from tcs_hil.service.settings import ControllerName, ServiceConfig


@dataclass(frozen=True)
class DrivenRun:
    """One run that has come to its end; ``evidence`` holds all it has left."""

    case: Case
    evidence: Evidence

    def expect(self, what: str, op: Op, value: float | str, **keys: Any) -> Finding:
        """Judge a limit on a metric of the run or on a signal, as in `[[expect]]`.

        ``signal`` names the signal of a metric that is of one; ``target``, ``band``,
        ``from_s`` and ``to_s`` are as in a scenario.

        Raises:
            AssertionError: the limit was not kept, or could not be judged.
            ConfigError: there is no such metric, signal or label.
        """
        __tracebackhide__ = True
        # No signal has a blank in its name: a misspelt metric is not taken for one.
        metric = what in RUN_METRICS or " " in what or "signal" in keys
        named: dict[str, Any] = {"metric" if metric else "signal": what, **keys}
        expect = Expect(op=op, value=_number(value), **named)
        check = prepare(expect, self.evidence.config.bus.database)
        finding = judge([check], self.evidence)[0]
        self._hold([finding])
        return finding

    def keep_its_limits(self) -> None:
        """Judge what the scenario itself expects, and what holds in every run.

        Raises:
            AssertionError: a limit was not kept, or could not be judged.
        """
        __tracebackhide__ = True
        self._hold(self.case.judge(self.evidence))

    def series(self, name: str) -> Series:
        """Samples of a signal.

        Raises:
            ConfigError: there is none of that name.
        """
        return self.evidence.series(namespace(self.evidence.config.bus.database).find(name))

    def _hold(self, findings: list[Finding]) -> None:
        __tracebackhide__ = True
        broken = [each for each in findings if each.verdict is not Verdict.PASSED]
        if broken:
            lines = [f"{each.verdict}: {each.limit}: {each.reason}" for each in broken]
            folder = self.evidence.files.folder
            raise AssertionError("\n".join([self.case.name, *lines, f"the run is in {folder}"]))


@dataclass(frozen=True)
class Driver:
    """Drives scenarios into ``folder``."""

    folder: Path

    def __call__(
        self,
        scenario: str | Path,
        controller: ControllerName | None = None,
        preset: PresetName | None = None,
        mode: Mode = "in-process",
        config: ServiceConfig | None = None,
    ) -> DrivenRun:
        """Drive one scenario to its end, on an embedded bus of its own unless in process.

        Raises:
            TcsError: scenario or configuration cannot be used, or the run failed.
        """
        case = scenario_case(str(scenario), ServiceConfig() if config is None else config)
        case = with_law(case, controller, preset)
        check_cases([case])
        bench = Bench(mode, self.folder)
        service = structs.replace(case.config, bus=bench.bus("test"))
        files = execute(RunPlan(case.scenario, service, mode, bench.case_folder(case.name)))
        return DrivenRun(case, Evidence(files, case.scenario, service, mode))


def _number(value: float | str) -> float | str:
    return value if isinstance(value, str) else float(value)
