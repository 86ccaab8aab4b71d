"""``tcs-hil demo``."""

from __future__ import annotations

from collections.abc import Iterable
from datetime import datetime
from pathlib import Path

import click
import msgspec
from rich.console import Console
from rich.table import Table

from tcs_hil.cli.options import json_option
from tcs_hil.cli.progress import progress_bar
from tcs_hil.console import NAME
from tcs_hil.errors import ConfigError
from tcs_hil.hil.demo import Demo, Outcome, run_demo
from tcs_hil.hil.machine import describe_machine
from tcs_hil.hil.processes.interruption import interrupted_by_sigterm
from tcs_hil.hil.report.page import write_report
from tcs_hil.hil.suite.provenance import sum_up
from tcs_hil.hil.table import (
    COLUMNS,
    RUN_COLUMNS,
    SLIP_COLUMNS,
    TIMING_COLUMNS,
    Columns,
    as_dict,
    markdown,
    row,
)

WIDE = 245
"""Characters the whole table takes."""


@click.command()
@click.option(
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path("runs/demo"),
    show_default=True,
    help="Folder for figures, page, recordings and logs.",
)
@click.option(
    "--interface", type=NAME, default="auto", show_default=True, help="As for `tcs-hil run`."
)
@click.option(
    "--channel", type=NAME, help="As for `tcs-hil run`; without it vcan0, or one of our own."
)
@json_option
def command(output: Path, interface: str, channel: str | None, as_json: bool) -> None:
    """Run both manoeuvres of the paper with every controller, between two processes on a bus.

    Each run is made twice: in lockstep, where the plant waits for the answer,
    and in real time, where both processes keep a 2 ms grid.

    Example: tcs-hil demo --output runs/demo
    """
    try:
        output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ConfigError(f"{output}: cannot be made ({error.strerror})") from error
    started = datetime.now().astimezone()
    with progress_bar("starting") as advance, interrupted_by_sigterm():
        demo = run_demo(output, interface, channel, advance)
    suite = sum_up(
        "Traction control on a CAN bus", [each.result for each in demo.outcomes], started
    )
    page = write_report(output, suite, figures=demo.figures)
    figures = msgspec.json.encode([as_dict(outcome) for outcome in demo.outcomes])
    (output / "results.json").write_bytes(figures)
    (output / "results.md").write_text(markdown(demo.outcomes), encoding="utf-8")
    if as_json:
        click.echo(figures)
        return
    _show(demo)
    click.echo(f"figures, recordings and page: {page}")


def _show(demo: Demo) -> None:
    """One table where it fits, else slip and timing one below the other."""
    console = Console()
    if not console.is_terminal:
        console = Console(width=WIDE)
    console.print(f"{demo.bus}; {describe_machine()}")
    if console.width >= WIDE:
        console.print(_table(COLUMNS, demo.outcomes))
        return
    console.print(_table(RUN_COLUMNS | SLIP_COLUMNS, demo.outcomes))
    timed = [outcome for outcome in demo.outcomes if outcome.choice.mode == "real-time"]
    console.print(_table(RUN_COLUMNS | TIMING_COLUMNS, timed))


def _table(columns: Columns, outcomes: Iterable[Outcome]) -> Table:
    table = Table()
    for heading in columns:
        table.add_column(heading, justify="right", overflow="fold")
    for outcome in outcomes:
        table.add_row(*row(outcome, columns))
    return table
