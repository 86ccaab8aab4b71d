"""``tcs-hil demo``."""

from __future__ import annotations

from pathlib import Path

import click
import msgspec
from rich.console import Console
from rich.table import Table

from tcs_hil.cli.options import json_option
from tcs_hil.cli.progress import progress_bar
from tcs_hil.hil.demo import run_demo
from tcs_hil.hil.machine import describe_machine
from tcs_hil.hil.page import write_page
from tcs_hil.hil.table import COLUMNS, as_dict, markdown, row


@click.command()
@click.option(
    "--output",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path("runs/demo"),
    show_default=True,
    help="Folder for figures, page, recordings and logs.",
)
@click.option("--interface", default="auto", show_default=True, help="As for `tcs-hil run`.")
@click.option("--channel", default="vcan0", show_default=True, help="As for `tcs-hil run`.")
@json_option
def command(output: Path, interface: str, channel: str, as_json: bool) -> None:
    """Run both manoeuvres of the paper with every controller, between two processes on a bus.

    Each run is made twice: in lockstep, where the plant waits for the answer,
    and in real time, where both processes keep a 2 ms grid.

    Example: tcs-hil demo --output runs/demo
    """
    output.mkdir(parents=True, exist_ok=True)
    with progress_bar("starting") as advance:
        demo = run_demo(output, interface, channel, advance)
    page = output / "index.html"
    write_page(page, demo)
    figures = msgspec.json.encode([as_dict(outcome) for outcome in demo.outcomes])
    (output / "results.json").write_bytes(figures)
    (output / "results.md").write_text(markdown(demo.outcomes), encoding="utf-8")
    if as_json:
        click.echo(figures)
        return
    table = Table(title=f"{demo.bus}; {describe_machine()}")
    for heading in COLUMNS:
        table.add_column(heading, justify="right")
    for outcome in demo.outcomes:
        table.add_row(*row(outcome))
    Console().print(table)
    click.echo(f"figures, recordings and page: {page}")
