"""The plant emulator measured: speed, cold start, convergence; and the figures of docs/plant.md.

    python -m benchmarks.plant                        the table
    python -m benchmarks.plant --json                 the same, for programs
    python -m benchmarks.plant --figures docs/plant   every verification as a picture
    python -m benchmarks.plant --write docs/plant.md  the table into the page

Times are CPU times, so that other programs count little.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Literal

import click
import msgspec
import numpy as np

from benchmarks.options import json_option, write_option
from benchmarks.plant_figures import save_all
from benchmarks.plant_runs import plant
from benchmarks.section import markdown, tell
from plant_emulator.emulator import PERIOD_NS, Emulator
from plant_emulator.plant import Plant
from plant_emulator.recording import TruthRecorder
from plant_emulator.scenario import load_scenario
from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.vehicle_node import VehicleNode
from tcs_hil.signals import TorqueLimits

PERIOD_S = PERIOD_NS * 1e-9
LIMITS = TorqueLimits(100.0, 100.0)
REPEATS = 7
FIRST_STEP = (
    "from plant_emulator.plant import Plant\n"
    "from plant_emulator.scenario import load_scenario\n"
    "plant = Plant(load_scenario('manoeuvre-1').with_variant('vehicle'))\n"
    "plant.step(None, 0.002)\n"
    "plant.signals()\n"
)


class Figure(msgspec.Struct, frozen=True):
    """One measured figure."""

    name: str
    value: float
    unit: str


def speed_factor(make: Callable[[], Callable[[], object]], seconds: float = 1.0) -> float:
    """How many times faster than real time one 2 ms tick runs; the best of several repeats."""
    ticks = round(seconds / PERIOD_S)
    best_s = np.inf
    for _ in range(REPEATS):
        tick = make()
        tick()
        start_s = time.thread_time()
        for _ in range(ticks):
            tick()
        best_s = min(best_s, time.thread_time() - start_s)
    return seconds / best_s


def stepping(variant: Literal["quarter-car", "vehicle"], *, sensors: bool) -> Callable[[], object]:
    """One tick of the plant alone, or with its sensors and the truth on record."""
    car = Plant(load_scenario("manoeuvre-1").with_variant(variant))
    if not sensors:
        return lambda: car.step(LIMITS, PERIOD_S)

    def tick() -> object:
        car.step(LIMITS, PERIOD_S)
        return car.signals(), car.row

    return tick


class _Nowhere:
    """A bus nobody listens to."""

    def send(self, frame_id: int, data: bytes, /) -> bool:  # noqa: ARG002
        """Accept the frame."""
        return True


def emulating() -> Callable[[], object]:
    """One tick with codec, end-to-end protection and the emulated wire."""
    scenario = load_scenario("manoeuvre-1").with_variant("vehicle")
    node, recorder = VehicleNode(load_database()), TruthRecorder(None, scenario)
    emulator = Emulator(Plant(scenario), node, _Nowhere(), recorder)
    now_ns = 0

    def tick() -> None:
        nonlocal now_ns
        emulator.publish()
        now_ns += PERIOD_NS
        emulator.advance_to(now_ns)

    return tick


def first_step_s(cache: str | None) -> float:
    """CPU seconds from starting Python to the first step, from an empty cache or the usual one."""
    environment = os.environ | ({"NUMBA_CACHE_DIR": cache} if cache else {})
    before = os.times()
    subprocess.run([sys.executable, "-c", FIRST_STEP], check=True, env=environment)
    after = os.times()
    return (
        after.children_user - before.children_user + after.children_system - before.children_system
    )


def end_speed_radps(step_s: float) -> float:
    """Speed of a driven wheel after a 50 ms push, integrated in steps of ``step_s``."""
    car = plant([(0.0, 80.0)], road=[{"mu": 0.6}], start_speed_kmph=36.0)
    for _ in range(round(0.05 / step_s)):
        car.step(None, step_s)
    return car.truth.wheel_speed_radps[0]


def convergence_order() -> tuple[float, float]:
    """Observed order between steps of 0.1 and 0.05 ms, and the error at 0.1 ms in rad/s."""
    exact = end_speed_radps(6.25e-6)
    coarse, fine = (abs(end_speed_radps(step_s) - exact) for step_s in (1e-4, 5e-5))
    return float(np.log2(coarse / fine)), coarse


def measure() -> list[Figure]:
    """Every figure of the table."""
    order, error = convergence_order()
    with tempfile.TemporaryDirectory() as empty:
        cold_s = first_step_s(empty)
    return [
        Figure(
            "quarter car, step", speed_factor(lambda: stepping("quarter-car", sensors=False)), "x"
        ),
        Figure("whole car, step", speed_factor(lambda: stepping("vehicle", sensors=False)), "x"),
        Figure(
            "whole car, step, sensors and truth",
            speed_factor(lambda: stepping("vehicle", sensors=True)),
            "x",
        ),
        Figure("the same with codec, E2E and wire", speed_factor(emulating), "x"),
        Figure("start to first step, nothing compiled yet", cold_s, "s"),
        Figure("start to first step, compiled before", first_step_s(None), "s"),
        Figure("observed order of convergence", order, ""),
        Figure("error of the wheel speed at 0.1 ms", error, "rad/s"),
    ]


@click.command()
@json_option
@write_option
@click.option("--figures", type=click.Path(path_type=Path), help="Write the pictures here.")
def main(machine_readable: bool, write: Path | None, figures: Path | None) -> None:
    """Measure the plant emulator, or draw its verification."""
    if figures is not None:
        save_all(figures, click.echo)
        return
    measured = measure()
    rows = [[figure.name, f"{figure.value:.3g} {figure.unit}".strip()] for figure in measured]
    table = markdown(("what", "figure"), rows)
    tell("benchmarks.plant", table, write, measured if machine_readable else None)


if __name__ == "__main__":
    main()
