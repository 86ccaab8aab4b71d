"""What each effect of the real car does to the paper's laws: every one switched on alone.

    python -m benchmarks.ablation
    python -m benchmarks.ablation --write docs/ablation.md

The bare car is the whole one with rigid shafts, motors without lag, tyres
without relaxation, fixed wheel loads, ideal sensors and a bus that takes no
time.  It still weighs what it weighs and drags what it drags.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click
from msgspec.structs import replace

from benchmarks.laws import LAWS
from benchmarks.options import json_option, law_option, write_option
from benchmarks.scores import HEADINGS, cells
from benchmarks.section import markdown, tell
from plant_emulator import bustiming, sensors
from plant_emulator.scenario import Scenario, VehicleTable, load_scenario
from tcs_hil.cli.progress import progress_bar
from tcs_hil.hil.batch import Job, judge_all
from tcs_hil.hil.metrics import Score
from tcs_hil.hil.paper import MANOEUVRES

FULL = VehicleTable(variant="vehicle")
BARE = replace(
    FULL,
    body=replace(FULL.body, load_transfer=False),
    tyre=replace(FULL.tyre, relaxation_m=0.0),
    driveline=replace(FULL.driveline, motor_lag_s=0.0, shaft_stiffness_nmprad=0.0),
)
DEFAULT_LAWS = ("nmpc-paper", "kmpc-paper")


def effects(scenario: Scenario) -> dict[str, Scenario]:
    """The scenario on the bare car, with each effect alone, and with all of them."""
    lag_s = FULL.driveline.motor_lag_s
    stiffness = FULL.driveline.shaft_stiffness_nmprad
    bare = replace(scenario, vehicle=BARE, sensors=sensors.IDEAL, bus=bustiming.IDEAL)
    return {
        "none": bare,
        "motor lag": _driveline(bare, motor_lag_s=lag_s),
        "half-shaft": _driveline(bare, shaft_stiffness_nmprad=stiffness),
        "tyre relaxation": _on(bare, tyre=FULL.tyre),
        "load transfer": _on(bare, body=FULL.body),
        "sensors (48 teeth)": replace(bare, sensors=scenario.sensors),
        "bus and transport delay": replace(bare, bus=scenario.bus),
        "all": replace(scenario, vehicle=FULL),
    }


@dataclass(frozen=True)
class Row:
    """One law on one car."""

    law: str
    manoeuvre: str
    effect: str
    score: Score


def drive(laws: Sequence[str]) -> list[Row]:
    """Every law through both manoeuvres on every car, with progress on stderr."""
    keys, jobs = [], []
    for law in laws:
        for manoeuvre in MANOEUVRES:
            for effect, scenario in effects(load_scenario(manoeuvre)).items():
                keys.append((law, manoeuvre, effect))
                jobs.append(Job(f"{law}, {manoeuvre}, {effect}", scenario, LAWS[law]))
    with progress_bar("ablation") as advance:
        scores = judge_all(jobs, advance)
    return [Row(*key, score) for key, score in zip(keys, scores, strict=True)]


def report(rows: Sequence[Row]) -> list[str]:
    """A table per law and manoeuvre, as Markdown."""
    lines: list[str] = []
    for law, manoeuvre in dict.fromkeys((row.law, row.manoeuvre) for row in rows):
        table = [
            [row.effect, *cells(row.score)]
            for row in rows
            if (row.law, row.manoeuvre) == (law, manoeuvre)
        ]
        lines += [f"### {law}, {manoeuvre}: {MANOEUVRES[manoeuvre]}", ""]
        lines += [*markdown(("effect", *HEADINGS), table), ""]
    return lines


def _on(scenario: Scenario, **parts: Any) -> Scenario:
    return replace(scenario, vehicle=replace(scenario.vehicle, **parts))


def _driveline(scenario: Scenario, **changes: float) -> Scenario:
    return _on(scenario, driveline=replace(scenario.vehicle.driveline, **changes))


@click.command()
@law_option(DEFAULT_LAWS)
@json_option
@write_option
def main(laws: tuple[str, ...], machine_readable: bool, write: Path | None) -> None:
    """Switch each effect of the plant on alone and judge the laws on it."""
    rows = drive(laws)
    tell("benchmarks.ablation", report(rows), write, rows if machine_readable else None)


if __name__ == "__main__":
    main()
