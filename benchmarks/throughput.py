"""How many times faster than real time one core drives a campaign's runs.

    python -m benchmarks.throughput --write docs/campaigns.md
    scripts/compiled .venv/bin python -m benchmarks.throughput   on the compiled tick

A run is driven whole, as a campaign's worker does it: plant, sensors, codec, E2E, wire and the
service's pipeline, with everything that is set up for it.  CPU time of the thread, the best of
several runs: other programs then count little.  OPENBLAS_NUM_THREADS=1, as Dask sets it for its
workers, keeps the set-up's linear algebra from waiting for threads.
"""

from __future__ import annotations

import time
from pathlib import Path
from typing import Literal

import click
import msgspec

from benchmarks.laws import LAWS
from benchmarks.options import json_option, write_option
from benchmarks.section import markdown, tell
from plant_emulator.scenario import Scenario, load_scenario
from tcs_hil.hil.simulation import simulate
from tcs_hil.native import tick_is_compiled
from tcs_hil.service.settings import ServiceConfig

SCENARIO = "manoeuvre-1"
VARIANTS: tuple[Literal["quarter-car", "vehicle"], ...] = ("quarter-car", "vehicle")
REPEATS = 5


class Row(msgspec.Struct, frozen=True):
    """Times real time of one law on one plant."""

    law: str
    plant: str
    factor: float


def factor(scenario: Scenario, config: ServiceConfig) -> float:
    """Seconds driven per second of CPU time, without the first run, which loads and compiles."""
    simulate(scenario, config)
    return scenario.duration_s / min(_cpu_s(scenario, config) for _ in range(REPEATS))


def measure() -> list[Row]:
    """Every law on both plants."""
    return [
        Row(law, variant, factor(load_scenario(SCENARIO).with_variant(variant), config))
        for law, config in LAWS.items()
        for variant in VARIANTS
    ]


def report(rows: list[Row]) -> list[str]:
    """A row per law, as Markdown."""
    by_law = {law: [row.factor for row in rows if row.law == law] for law in LAWS}
    table = [[law, *(f"{value:.1f}" for value in factors)] for law, factors in by_law.items()]
    tick = "compiled" if tick_is_compiled() else "interpreted"
    lines = markdown(("law", *(f"{variant}, x real time" for variant in VARIANTS)), table)
    return [*lines, "", f"Per core, {SCENARIO} in process, tick {tick}."]


def _cpu_s(scenario: Scenario, config: ServiceConfig) -> float:
    begin_s = time.thread_time()
    simulate(scenario, config)
    return time.thread_time() - begin_s


@click.command()
@json_option
@write_option
def main(machine_readable: bool, write: Path | None) -> None:
    """Drive one manoeuvre under every law and tell how much faster than real time."""
    rows = measure()
    tell("benchmarks.throughput", report(rows), write, rows if machine_readable else None)


if __name__ == "__main__":
    main()
