"""What every benchmark does with its table: puts it into a page, and shows it."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

import click
import msgspec
from rich.console import Console
from rich.markdown import Markdown

from tcs_hil.hil.machine import describe_machine
from tcs_hil.hil.section import markdown, replace_section

__all__ = ["markdown", "show", "tell", "write_section"]


def write_section(path: Path, name: str, lines: Iterable[str], part: str | None = None) -> None:
    """Replace or append the section of the benchmark ``name`` with the command that runs now.

    A benchmark may keep several sections in a page, each ``part`` by its name.
    """
    section = name if part is None else f"{name} {part}"
    replace_section(path, section, shlex.join(("python", "-m", name, *sys.argv[1:])), lines)


def tell(
    name: str, lines: Sequence[str], page: Path | None, rows: Sequence[object] | None = None
) -> None:
    """Put a benchmark's table into ``page``, if there is one, and print it.

    ``rows`` are printed in its place, as JSON, with the machine that made them; NaN
    becomes null.
    """
    if page is not None:
        write_section(page, name, lines)
    if rows is not None:
        click.echo(msgspec.json.encode({"machine": describe_machine(), "rows": rows}))
    else:
        show(lines)


def show(lines: Iterable[str]) -> None:
    """Print Markdown so that it is pleasant on a terminal and unchanged in a file."""
    console, text = Console(), "\n".join(lines)
    if console.is_terminal:
        console.print(Markdown(text))
    else:
        click.echo(text)
