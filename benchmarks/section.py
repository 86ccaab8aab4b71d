"""Generated sections of hand-written pages: between two comments, and only there."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Iterable
from pathlib import Path

import click
from rich.console import Console
from rich.markdown import Markdown

from tcs_hil.hil.machine import describe_machine


def write_section(path: Path, name: str, lines: Iterable[str]) -> None:
    """Replace what stands between the comments of section ``name``; append it where there is none.

    The section opens with the command and the machine that made it.
    """
    begin, end = f"<!-- begin {name} -->", f"<!-- end {name} -->"
    command = shlex.join(("python", "-m", name, *sys.argv[1:]))
    made_by = f"Made by `{command}` on {describe_machine()}."
    section = "\n".join((begin, made_by, "", *lines, end))
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    before, found, rest = text.partition(begin)
    after = rest.partition(end)[2] if found else "\n"
    gap = "" if found or not before else "\n"
    path.write_text(before + gap + section + after, encoding="utf-8")


def markdown(headings: Iterable[str], rows: Iterable[Iterable[str]]) -> list[str]:
    """A table with its first column to the left and figures to the right."""
    headings = list(headings)
    rule = ["---", *["--:"] * (len(headings) - 1)]
    return ["| " + " | ".join(cells) + " |" for cells in (headings, rule, *rows)]


def show(lines: Iterable[str]) -> None:
    """Print Markdown so that it is pleasant on a terminal and unchanged in a file."""
    console, text = Console(), "\n".join(lines)
    if console.is_terminal:
        console.print(Markdown(text))
    else:
        click.echo(text)
