"""``tcs-hil signals``."""

from __future__ import annotations

from pathlib import Path

import click

from tcs_hil.canbus.database import parse_dbc
from tcs_hil.canbus.signal_table import markdown_table


@click.command()
@click.argument("dbc", type=click.Path(dir_okay=False, path_type=Path), required=False)
def command(dbc: Path | None) -> None:
    """Print every signal of a DBC file, the built-in contract by default, as a Markdown table.

    Example: tcs-hil signals > docs/signals.md
    """
    click.echo(markdown_table(parse_dbc(dbc)[1]))
