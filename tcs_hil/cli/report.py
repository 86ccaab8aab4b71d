"""``tcs-hil report``."""

from __future__ import annotations

from pathlib import Path

import click

from tcs_hil.cli.options import json_option
from tcs_hil.cli.summary import show_summary
from tcs_hil.runtime.recording import read, read_info
from tcs_hil.runtime.summary import summarise


@click.command()
@click.argument("recording", type=click.Path(dir_okay=False, path_type=Path))
@json_option
def command(recording: Path, as_json: bool) -> None:
    """Show latency, jitter and states of a flight RECORDING, even while the service runs.

    Example: tcs-hil report run.tcsrec
    """
    if not as_json:
        info = read_info(recording)
        click.echo(f"{info.controller} on {info.bus}, {info.machine}")
    show_summary(summarise(read(recording)), as_json)
