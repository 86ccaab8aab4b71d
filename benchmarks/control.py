"""How well the control laws hold slip on a car that is none of theirs, behind a bus that delays.

    python -m benchmarks.control                                both manoeuvres and the library
    python -m benchmarks.control --quick                        both manoeuvres only
    python -m benchmarks.control --write docs/control-results.md

The car is the whole one with its default driveline and sensors, the bus the
default one.  Every scenario of the library is driven by the tuned PI too, which
the predictive laws must not fall behind by more than five percent.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import click

from benchmarks.laws import DEFAULTS, LAWS, YARDSTICK
from benchmarks.options import json_option, write_option
from benchmarks.scores import HEADINGS, cells
from benchmarks.section import markdown, tell
from plant_emulator.scenario import list_scenarios, load_scenario
from tcs_hil.cli.progress import progress_bar
from tcs_hil.control.settings import ControlSettings
from tcs_hil.hil.batch import Job, judge_all
from tcs_hil.hil.metrics import Score
from tcs_hil.hil.paper import MANOEUVRES

TOLERANCE = 0.05
REFERENCE = ControlSettings().slip_reference
LIMITS = {"manoeuvre-1": ("0.015", "0.20"), "manoeuvre-2": ("0.035", "0.28")}
STRETCH = {"manoeuvre-1": ("0.007", "0.13"), "manoeuvre-2": ("0.020", "0.22")}


@dataclass(frozen=True)
class Row:
    """One law in one scenario."""

    scenario: str
    law: str
    score: Score


def drive(scenarios: Sequence[str], laws: Sequence[str], title: str) -> list[Row]:
    """Every law through every scenario, with progress on stderr."""
    keys = [(scenario, law) for scenario in scenarios for law in laws]
    jobs = [
        Job(f"{scenario}, {law}", load_scenario(scenario).with_variant("vehicle"), LAWS[law])
        for scenario, law in keys
    ]
    with progress_bar(title) as advance:
        scores = judge_all(jobs, advance)
    return [Row(*key, score) for key, score in zip(keys, scores, strict=True)]


def against_the_table(rows: Sequence[Row], manoeuvre: str) -> list[str]:
    """One manoeuvre beside what was asked for, as Markdown."""
    table = [
        ["*limit*", *LIMITS[manoeuvre], "0.97", "300", "none"],
        ["*stretch*", *STRETCH[manoeuvre], "0.99", "150", "none"],
    ]
    table += [[row.law, *cells(row.score)] for row in rows if row.scenario == manoeuvre]
    title = f"### {manoeuvre}: {MANOEUVRES[manoeuvre]}"
    return [title, "", *markdown(("law", *HEADINGS), table), ""]


def against_the_yardstick(rows: Sequence[Row]) -> list[str]:
    """The library: three figures of each law, and those in which it falls behind, as Markdown."""
    scores = {(row.scenario, row.law): row.score for row in rows}
    scenarios = list(dict.fromkeys(row.scenario for row in rows))
    table = []
    for scenario in scenarios:
        yardstick = scores[scenario, YARDSTICK]
        table.append([scenario, _three(yardstick)])
        for law in DEFAULTS:
            behind = worse_in(scores[scenario, law], yardstick)
            table[-1] += [_three(scores[scenario, law]), ", ".join(behind) or "-"]
    headings = ["scenario", YARDSTICK, *(text for law in DEFAULTS for text in (law, "worse in"))]
    title = "### The library: RMSE / peak / speed gained in m/s"
    held = [f"No worse than {YARDSTICK} in all three: {_held(scores, scenarios)}."]
    return [title, "", *markdown(headings, table), "", *held]


def worse_in(score: Score, yardstick: Score) -> list[str]:
    """Figures in which a run falls behind the yardstick's by more than the tolerance.

    A peak that does not exceed the reference is no overshoot, whatever the
    yardstick's is.
    """
    slip, other = score.slip, yardstick.slip
    least_mps = yardstick.gained_mps - TOLERANCE * abs(yardstick.gained_mps)
    most_ratio = (1.0 + TOLERANCE) * max(other.peak_ratio, REFERENCE)
    behind = {
        # A NaN, where the reference was never reachable, is not worse than anything.
        "RMSE": slip.rmse_ratio > (1.0 + TOLERANCE) * other.rmse_ratio,
        "peak": slip.peak_ratio > most_ratio,
        "gain": score.gained_mps < least_mps,
    }
    return [figure for figure, is_worse in behind.items() if is_worse]


def _three(score: Score) -> str:
    slip = score.slip
    return f"{slip.rmse_ratio:.4f} / {slip.peak_ratio:.3f} / {score.gained_mps:.2f}"


def _held(scores: dict[tuple[str, str], Score], scenarios: Sequence[str]) -> str:
    counts = (
        (law, sum(not worse_in(scores[s, law], scores[s, YARDSTICK]) for s in scenarios))
        for law in DEFAULTS
    )
    return ", ".join(f"{law} in {count} of {len(scenarios)}" for law, count in counts)


@click.command()
@click.option("--quick", is_flag=True, help="Only the paper's two manoeuvres.")
@json_option
@write_option
def main(quick: bool, machine_readable: bool, write: Path | None) -> None:
    """Judge every law in both manoeuvres, and the default ones against the PI in the library."""
    rows = drive(list(MANOEUVRES), list(LAWS), "manoeuvres")
    lines = [line for manoeuvre in MANOEUVRES for line in against_the_table(rows, manoeuvre)]
    if not quick:
        others = [item.name for item in list_scenarios() if item.name not in MANOEUVRES]
        rows += drive(others, (YARDSTICK, *DEFAULTS), "library")
        lines += against_the_yardstick([row for row in rows if row.law in (YARDSTICK, *DEFAULTS)])
    tell("benchmarks.control", lines, write, rows if machine_readable else None)


if __name__ == "__main__":
    main()
