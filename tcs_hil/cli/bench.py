"""``tcs-hil bench``."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path

import click
import msgspec
from rich.console import Console
from rich.markdown import Markdown

from tcs_hil.cli.options import check_folder, json_option
from tcs_hil.cli.progress import progress_bar
from tcs_hil.console import FiniteRange, refuse
from tcs_hil.errors import ConfigError, offer
from tcs_hil.hil.bench.effort import FULL, QUICK
from tcs_hil.hil.bench.page import page
from tcs_hil.hil.bench.result import MEASURES, Result, measure
from tcs_hil.hil.section import replace_section

WIDE = 140
"""Columns of a terminal in which the tables fit; in fewer their Markdown is easier to read."""


@click.command()
@click.option("--quick", is_flag=True, help="Few repetitions: to see that everything works.")
@click.option("--only", metavar="PARTS", help=f"Some of {','.join(MEASURES)}. [all]")
@click.option("--seconds", type=FiniteRange(1.0, 3600.0), help="On the bus. [60, quick 1]")
@click.option(
    "--write",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Also put the tables into this page, in the section that is marked for them.",
)
@json_option
def command(
    quick: bool, only: str | None, seconds: float | None, write: Path | None, as_json: bool
) -> None:
    """Time the laws beside their peers, whole ticks, the service on a bus, and its start.

    Takes less than five minutes on a machine that does nothing else.

    Example: tcs-hil bench --only controllers,tick
    """
    effort = QUICK if quick else FULL
    if seconds is not None:
        effort = effort._replace(bus_s=seconds)
    check_folder(write)
    parts = _parts(only)
    if "bus" not in parts:
        refuse(
            {"seconds": seconds}, ["seconds"], "it is for the part `bus`, which --only leaves out"
        )
    with progress_bar("bench") as advance:
        result = measure(parts, effort, advance)
    if write is not None:
        replace_section(
            write, "tcs-hil bench", shlex.join(("tcs-hil", *sys.argv[1:])), page(result)
        )
    _show(result, as_json)


def _parts(only: str | None) -> list[str]:
    parts = list(MEASURES) if only is None else only.split(",")
    for part in parts:
        if part not in MEASURES:
            raise ConfigError(f"--only: there is no part {part!r}{offer(part, MEASURES)}")
    return parts


def _show(result: Result, as_json: bool) -> None:
    console, text = Console(), "\n".join(page(result))
    if as_json:
        click.echo(msgspec.json.encode(result).decode())
    elif console.is_terminal and console.width >= WIDE:
        console.print(Markdown(text))
    else:
        click.echo(text)
