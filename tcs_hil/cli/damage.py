"""How a recording that could not be read to its end is told of."""

from __future__ import annotations

import click

INCOMPLETE = 3
"""Exit status where all went well with a part of what was given: see stderr."""


def warn_of(lost: str) -> None:
    """Say what was lost, on stderr; nothing where nothing was."""
    if lost:
        click.echo(f"tcs-hil: warning: {lost}", err=True)
