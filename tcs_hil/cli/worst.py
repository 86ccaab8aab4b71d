"""The worst ticks of a run on the screen."""

from __future__ import annotations

from collections.abc import Sequence

import click
from rich.console import Console
from rich.table import Table

from tcs_hil.runtime.worst import STAGES, BadTick

LABELS = {
    "wake": "woke",
    "receive": "recv",
    "solve_fl": "fl",
    "solve_fr": "fr",
    "decide": "rest",
    "send": "send",
}


def print_worst(ticks: Sequence[BadTick]) -> None:
    """Print a line per tick in the order of time; a star marks the stage to blame."""
    table = Table(title="the slowest ticks, times in µs", box=None, padding=(0, 1, 0, 0))
    stages = (LABELS[stage] for stage in STAGES)
    for heading in ("at s", "tick", "took", *stages, "in", "skip", "iter", "state"):
        table.add_column(heading, justify="right")
    for tick in ticks:
        table.add_row(*_cells(tick))
    Console().print(table)
    click.echo(
        "took: due to sent; woke: late; fl, fr: control laws; rest: of the decision; in: frames;\n"
        "* took most beyond its median"
    )


def _cells(tick: BadTick) -> list[str]:
    stages = [
        f"{time_us:.0f}{'*' if stage == tick.culprit else ''}"
        for stage, time_us in tick.stages_us.items()
    ]
    return [
        f"{tick.at_s:.3f}",
        f"{tick.number}",
        f"{tick.response_us:.0f}",
        *stages,
        f"{tick.frames}",
        f"{tick.skipped}",
        "/".join(str(count) for count in tick.iterations),
        _state(tick),
    ]


def _state(tick: BadTick) -> str:
    """The state, with what went wrong beside it."""
    troubles = [name for name in dict.fromkeys(tick.statuses) if name != "OK"]
    if tick.overrun:
        troubles.append("overrun")
    if tick.failed:
        troubles.append("failed")
    return " ".join([tick.state, *troubles])
