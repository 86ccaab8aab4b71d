"""``tcs-hil hil``."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any, get_args

import click
import msgspec

from tcs_hil.cli.options import BUS_OPTIONS, bus_options, check_folder, json_option
from tcs_hil.cli.progress import progress_bar
from tcs_hil.cli.verdicts import show
from tcs_hil.console import refuse
from tcs_hil.errors import ConfigError
from tcs_hil.hil.judging.verdict import Verdict
from tcs_hil.hil.processes.interruption import interrupted_by_sigterm
from tcs_hil.hil.report.page import write_report
from tcs_hil.hil.run import MODES
from tcs_hil.hil.suite.case import Case, check_cases, distinct, with_law
from tcs_hil.hil.suite.junit import write_junit
from tcs_hil.hil.suite.library import scenario_case, suite_cases
from tcs_hil.hil.suite.provenance import sum_up
from tcs_hil.hil.suite.result import SuiteResult, load_results
from tcs_hil.hil.suite.runner import Bench, run_cases
from tcs_hil.service.settings import ControllerName, ServiceConfig, read_service

EXIT_STATUS = {Verdict.PASSED: 0, Verdict.FAILED: 1, Verdict.BLOCKED: 3}
CONTROLLERS: tuple[ControllerName, ...] = get_args(ControllerName)


@dataclass(frozen=True, slots=True)
class Outputs:
    """Where the figures go."""

    folder: Path
    junit: Path | None
    baseline: tuple[Path, SuiteResult] | None
    as_json: bool


@click.command()
@click.argument("scenarios", nargs=-1, metavar="[SCENARIO]...")
@click.option(
    "--suite",
    "suites",
    multiple=True,
    help="A folder of the library, `all`, `faults` or `fault-families`; may be repeated.",
)
@click.option(
    "--mode",
    type=click.Choice(MODES),
    default="lockstep",
    show_default=True,
    help="lockstep: the plant waits for the service; real-time: a 2 ms grid; in-process: no bus.",
)
@click.option(
    "--controller",
    metavar="NAME[,NAME]...",
    help=f"Laws to drive each scenario with ({', '.join(CONTROLLERS)}); its own without it.",
)
@click.option(
    "--preset", type=click.Choice(["paper", "default"]), help="Instead of the scenario's own."
)
@click.option(
    "--config",
    "config_path",
    type=click.Path(dir_okay=False, path_type=Path),
    help="The service's TOML file, as for `tcs-hil run`; the scenario chooses the law.",
)
@bus_options
@click.option("-j", "--jobs", type=click.IntRange(min=1), help="Cases driven at a time.")
@click.option(
    "--out",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path("runs/hil"),
    show_default=True,
    help="Folder for report, results and the files of each run.",
)
@click.option(
    "--junit", type=click.Path(dir_okay=False, path_type=Path), help="Also write JUnit XML."
)
@click.option(
    "--baseline",
    type=click.Path(file_okay=False, path_type=Path),
    help="The --out folder of an earlier run, to be compared with.",
)
@json_option
def command(scenarios: tuple[str, ...], **options: Any) -> None:
    """Drive scenarios against the service, judge their limits and write a report.

    Each SCENARIO is the name of a shipped one (`plant-emulator list`) or a TOML file.

    Exit status: 0 all passed, 1 any failed, 3 none failed but something could not be
    judged, 2 a mistake in what was asked.

    Example: tcs-hil hil launch-mu-030 my-scenario.toml --controller kmpc,nmpc -j 2
    """
    cases, bench = _cases(scenarios, options), _bench(options)
    jobs = min(bench.jobs(options["jobs"]), len(cases))
    bench.check_bus()
    outputs = _outputs(options)
    started = datetime.now().astimezone()
    with progress_bar("starting") as advance, interrupted_by_sigterm():
        results = run_cases(cases, bench, jobs, advance)
    suite = sum_up(", ".join((*options["suites"], *scenarios)), results, started, jobs)
    _publish(suite, outputs)
    click.get_current_context().exit(EXIT_STATUS[suite.verdict])


def _bench(options: dict[str, Any]) -> Bench:
    if options["mode"] == "in-process":
        refuse(options, BUS_OPTIONS, "a run in process has no bus")
    channel = options["channel"] or ("vcan0" if options["interface"] else None)
    if channel is None:
        refuse(options, ["bitrate"], "without --channel each case has an embedded bus of its own")
    return Bench(
        options["mode"],
        options["out"],
        options["interface"] or "auto",
        channel,
        options["bitrate"],
    )


def _cases(scenarios: tuple[str, ...], options: dict[str, Any]) -> list[Case]:
    path = options["config_path"]
    config = ServiceConfig() if path is None else read_service(path)
    cases = [case for name in options["suites"] for case in suite_cases(name, config)]
    cases += [scenario_case(name, config) for name in scenarios]
    if not cases:
        raise click.UsageError("name a scenario or a --suite")
    laws = _controllers(options["controller"])
    cases = distinct(with_law(case, law, options["preset"]) for case in cases for law in laws)
    check_cases(cases)
    return cases


def _controllers(names: str | None) -> list[ControllerName | None]:
    if names is None:
        return [None]
    try:
        return [CONTROLLERS[CONTROLLERS.index(name)] for name in names.split(",")]
    except ValueError:
        known = ", ".join(CONTROLLERS)
        raise ConfigError(f"--controller {names}: the laws are {known}") from None


def _outputs(options: dict[str, Any]) -> Outputs:
    """Everything that could be refused is refused before the first run."""
    folder, baseline = options["out"], options["baseline"]
    check_folder(options["junit"])
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ConfigError(f"{folder}: cannot be made ({error.strerror})") from error
    earlier = None if baseline is None else (baseline, load_results(baseline))
    return Outputs(folder, options["junit"], earlier, options["as_json"])


def _publish(suite: SuiteResult, outputs: Outputs) -> None:
    suite.save(outputs.folder)
    page = write_report(outputs.folder, suite, outputs.baseline)
    if outputs.junit is not None:
        write_junit(outputs.junit, suite)
    if outputs.as_json:
        click.echo(msgspec.json.encode(suite))
    else:
        show(suite, None if outputs.baseline is None else outputs.baseline[1])
        click.echo(f"report: {page}")
