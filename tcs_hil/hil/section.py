"""Generated sections of hand-written pages: between two comments, and only there."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from tcs_hil.hil.machine import describe_machine


def replace_section(path: Path, name: str, command: str, lines: Iterable[str]) -> None:
    """Replace what stands between the comments of section ``name``; append it where there is none.

    The section opens with the command and the machine that made it.
    """
    begin, end = f"<!-- begin {name} -->", f"<!-- end {name} -->"
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
