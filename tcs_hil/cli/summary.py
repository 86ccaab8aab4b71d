"""The summary of a run on the screen."""

from __future__ import annotations

import json

import click
from rich.console import Console
from rich.table import Table

from tcs_hil.runtime.summary import Percentiles, Summary

TIMES = {
    "wake_jitter": "wake jitter",
    "receive": "receive",
    "step": "decide",
    "send": "send",
    "total": "whole tick",
    "solve": "control law, per wheel",
    "latency": "latency, speed in to limit out",
    "input_age": "age of the rear speeds",
}


def show_summary(summary: Summary, as_json: bool) -> None:
    """Print a summary as a table, or as JSON for a program to read."""
    if as_json:
        click.echo(json.dumps(summary.as_dict()))
    else:
        print_summary(summary)


def print_summary(summary: Summary) -> None:
    """Print a summary as a table."""
    table = Table(title=f"{summary.ticks} ticks, times in µs")
    table.add_column("")
    for heading in ("mean", "p50", "p99", "p99.9", "p99.99", "max"):
        table.add_column(heading, justify="right")
    for name, label in TIMES.items():
        table.add_row(label, *_cells(getattr(summary, name)))
    Console().print(table)
    click.echo(
        f"overruns {summary.overruns}, skipped ticks {summary.skipped}, "
        f"failed ticks {summary.failures}, bus errors {summary.bus_errors}, "
        f"lost frames {summary.lost_frames}, E2E errors {summary.e2e_errors}"
    )
    click.echo(f"states: {_counts(summary.states)}; solver: {_counts(summary.statuses)}")
    if summary.advice:
        click.echo(summary.advice)


def _cells(times: Percentiles | None) -> list[str]:
    if times is None:
        return ["-"] * 6
    return [
        f"{value:.1f}"
        for value in (
            times.mean_us,
            times.p50_us,
            times.p99_us,
            times.p99_9_us,
            times.p99_99_us,
            times.max_us,
        )
    ]


def _counts(counts: dict[str, int]) -> str:
    return ", ".join(f"{name} {count}" for name, count in counts.items()) or "none"
