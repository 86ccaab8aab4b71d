"""Options that several benchmarks have."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeVar

import click

from benchmarks.laws import LAWS

F = TypeVar("F", bound=Callable[..., Any])

json_option = click.option(
    "--json", "machine_readable", is_flag=True, help="Print JSON instead of tables."
)
write_option = click.option(
    "--write", type=click.Path(dir_okay=False, path_type=Path), help="Page to put the tables into."
)


def law_option(default: Sequence[str]) -> Callable[[F], F]:
    """Choose among the laws that are compared; may be given several times."""
    return click.option(
        "--law",
        "laws",
        type=click.Choice(list(LAWS)),
        multiple=True,
        default=default,
        show_default=True,
        help="May be given several times.",
    )
