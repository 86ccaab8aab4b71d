"""The fault campaign's table: every fault in both manoeuvres under every law, in lockstep.

    python -m benchmarks.faults                        a table
    python -m benchmarks.faults --write docs/safety.md
    python -m benchmarks.faults --mode in-process      faster, no bus
    scripts/with-vcan --rw . -- python -m benchmarks.faults --channel vcan0 --write docs/safety.md

With a channel the bus is a real one, and one fault of every family is driven.
The same cells and judge as ``tcs-hil hil --suite faults`` and ``fault-families``.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import click

from benchmarks.section import markdown, show, write_section
from tcs_hil.cli.progress import progress_bar
from tcs_hil.console import NAME
from tcs_hil.hil.faults.cell import Cell
from tcs_hil.hil.faults.suite import family_cases, family_cells, fault_cases, fault_cells
from tcs_hil.hil.faults.table import headings, legend, rows, shortfalls, summary
from tcs_hil.hil.run import MODES, Mode
from tcs_hil.hil.suite.case import Case
from tcs_hil.hil.suite.result import Result
from tcs_hil.hil.suite.runner import Bench, run_cases
from tcs_hil.service.settings import ServiceConfig


def drive(cases: Sequence[Case], mode: Mode, channel: str | None, jobs: int | None) -> list[Result]:
    """Every case, its files thrown away."""
    with tempfile.TemporaryDirectory() as folder, progress_bar("fault campaign") as advance:
        bench = Bench(mode, Path(folder), "socketcan", channel)
        return run_cases(cases, bench, bench.jobs(jobs), advance)


def place(mode: Mode, channel: str | None) -> str:
    """Where the campaign is driven, and at which pace."""
    if mode == "in-process":
        return "in one process"
    bus = "the embedded bus" if channel is None else f"SocketCAN's {channel}"
    return f"in {mode.replace('-', ' ')} over two processes on {bus}"


def page(cells: Sequence[Cell], results: Sequence[Result], where: str) -> list[str]:
    """Everything there is to tell, as Markdown."""
    failed = shortfalls(results)
    return [
        summary(cells, results, where),
        *(("", *failed) if failed else ()),
        "",
        *markdown(headings(results), rows(cells, results)),
        "",
        "Nothing is owed where",
        "",
        *legend(cells),
    ]


@click.command()
@click.option("--mode", type=click.Choice(MODES), default="lockstep", show_default=True)
@click.option(
    "--channel", type=NAME, help="A SocketCAN interface to drive one fault of every family on."
)
@click.option("-j", "--jobs", type=click.IntRange(min=1), help="Cases driven at a time.")
@click.option(
    "--write", type=click.Path(dir_okay=False, path_type=Path), help="Page to put the table into."
)
def main(mode: Mode, channel: str | None, jobs: int | None, write: Path | None) -> None:
    """Drive the campaign and tell what came of every cell; exit status 1 if any did not pass."""
    cells, cases = (fault_cells, fault_cases) if channel is None else (family_cells, family_cases)
    results = drive(cases(ServiceConfig()), mode, channel, jobs)
    lines = page(cells(), results, place(mode, channel))
    if write:
        write_section(write, "benchmarks.faults", lines, part=channel)
    show(lines)
    sys.exit(any(shortfalls(results)))


if __name__ == "__main__":
    main()
