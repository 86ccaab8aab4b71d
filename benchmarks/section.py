"""What every benchmark does with its table: shows it, and puts it into a page."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Iterable
from pathlib import Path

import click
from rich.console import Console
from rich.markdown import Markdown

from tcs_hil.hil.section import markdown, replace_section

__all__ = ["markdown", "show", "write_section"]


def write_section(path: Path, name: str, lines: Iterable[str]) -> None:
    """Replace or append the section of the benchmark ``name`` with the command that runs now."""
    replace_section(path, name, shlex.join(("python", "-m", name, *sys.argv[1:])), lines)


def show(lines: Iterable[str]) -> None:
    """Print Markdown so that it is pleasant on a terminal and unchanged in a file."""
    console, text = Console(), "\n".join(lines)
    if console.is_terminal:
        console.print(Markdown(text))
    else:
        click.echo(text)
