"""Verdicts of a suite on the screen."""

from __future__ import annotations

import click
from rich.console import Console
from rich.table import Table
from rich.text import Text

from tcs_hil.console import counted
from tcs_hil.hil.judging.verdict import Verdict
from tcs_hil.hil.suite.result import Result, SuiteResult

STYLES = {Verdict.PASSED: "green", Verdict.FAILED: "bold red", Verdict.BLOCKED: "yellow"}
WIDE = 160


def show(suite: SuiteResult, baseline: SuiteResult | None) -> None:
    """A line per case, worst at the end where the eye is, and the sum."""
    before = {} if baseline is None else {result.name: result for result in baseline.results}
    table = Table(box=None, padding=(0, 1, 0, 0))
    for heading in ("verdict", "case", "RMSE", "peak", "gain", "why"):
        table.add_column(heading, overflow="fold", no_wrap=heading == "case")
    order = (Verdict.PASSED, Verdict.BLOCKED, Verdict.FAILED)
    for result in sorted(suite.results, key=lambda each: order.index(each.verdict)):
        table.add_row(*_cells(result, before.get(result.name)))
    console = Console()
    if not console.is_terminal:
        console = Console(width=WIDE)
    console.print(table)
    click.echo(_sum(suite))


def _cells(result: Result, before: Result | None) -> list[Text]:
    verdict = Text(result.verdict, STYLES[result.verdict])
    if before is not None and before.verdict is not result.verdict:
        verdict.append(f" (was {before.verdict})", "default")
    figures = (
        _figure(result.figures.get(name))
        for name in ("slip RMSE", "peak slip", "speed gained ratio")
    )
    return [verdict, *(Text(cell) for cell in (result.name, *figures, result.reason))]


def _figure(value: float | None) -> str:
    return "-" if value is None else f"{value:.3f}"


def _sum(suite: SuiteResult) -> str:
    counts = (f"{suite.count(verdict)} {verdict}" for verdict in Verdict)
    return f"{counted(len(suite.results), 'case')}: {', '.join(counts)}; {suite.wall_s:.0f} s"
