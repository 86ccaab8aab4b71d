"""Progress of long work, on stderr so that output can be piped."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import click
from rich.console import Console
from rich.progress import Progress


@contextmanager
def progress_bar(what: str) -> Iterator[Callable[..., None]]:
    """A bar that is set to a share of the work, from 0 to 1, and may be told what comes next.

    Without a terminal a line is printed for each thing that comes next.
    """
    console = Console(stderr=True)
    with Progress(console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task(what, total=1.0)
        shown = ""

        def advance(share: float, what_next: str = what) -> None:
            nonlocal shown
            progress.update(task, completed=share, description=what_next)
            if not console.is_terminal and what_next != shown:
                click.echo(f"{share:4.0%} {what_next}", err=True)
                shown = what_next

        yield advance
