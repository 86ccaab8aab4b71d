"""The fault campaign's table: every fault in both manoeuvres under every law.

    python -m benchmarks.faults                        a table
    python -m benchmarks.faults --write docs/safety.md
    python -m benchmarks.faults --mode in-process      several times faster, no bus

The same cells and judge as ``tcs-hil hil --suite faults``.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import click

from benchmarks.section import markdown, show, write_section
from tcs_hil.cli.progress import progress_bar
from tcs_hil.hil.faults.suite import fault_cases, fault_cells
from tcs_hil.hil.faults.table import HEADINGS, legend, rows, summary
from tcs_hil.hil.run import MODES, Mode
from tcs_hil.hil.suite.result import Result
from tcs_hil.hil.suite.runner import Bench, run_cases
from tcs_hil.service.settings import ServiceConfig


def drive(mode: Mode, jobs: int | None) -> list[Result]:
    """Every case, its files thrown away."""
    cases = fault_cases(ServiceConfig())
    with tempfile.TemporaryDirectory() as folder, progress_bar("fault campaign") as advance:
        bench = Bench(mode, Path(folder))
        return run_cases(cases, bench, bench.jobs(jobs), advance)


@click.command()
@click.option("--mode", type=click.Choice(MODES), default="lockstep", show_default=True)
@click.option("-j", "--jobs", type=click.IntRange(min=1), help="Cases driven at a time.")
@click.option(
    "--write", type=click.Path(dir_okay=False, path_type=Path), help="Page to put the table into."
)
def main(mode: Mode, jobs: int | None, write: Path | None) -> None:
    """Drive the campaign and tell what came of every cell."""
    results, cells = drive(mode, jobs), fault_cells()
    table = markdown(HEADINGS, rows(cells, results))
    lines = [summary(cells, results), "", *table, "", "Nothing is owed where", "", *legend(cells)]
    if write:
        write_section(write, "benchmarks.faults", lines)
    show(lines)


if __name__ == "__main__":
    main()
