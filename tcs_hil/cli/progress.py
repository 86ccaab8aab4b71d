"""Progress of long work, on stderr so that output can be piped."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import Progress


@contextmanager
def progress_bar(what: str) -> Iterator[Callable[..., None]]:
    """A bar that is set to a share of the work, from 0 to 1, and may be told what comes next."""
    with Progress(console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task(what, total=1.0)

        def advance(share: float, what_next: str = what) -> None:
            progress.update(task, completed=share, description=what_next)

        yield advance
