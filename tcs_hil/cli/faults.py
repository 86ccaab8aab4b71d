"""``tcs-hil faults``."""

from __future__ import annotations

import click

from tcs_hil.fault_table import markdown_table


@click.command()
def command() -> None:
    """Print every fault code, its meaning and the reaction to it as a Markdown table.

    Example: tcs-hil faults > docs/faults.md
    """
    click.echo(markdown_table())
