"""Time of a step of each law, native and in Python, beside the paper's own figures.

    python -m benchmarks.controllers                    a table
    python -m benchmarks.controllers --json > out.json  the same, for programs

The published laws drive the paper's quarter car without delay, the default ones
a car with driveline, 6 ms behind.  Steps without a driver's request solve
nothing and are left out.  Wall time contains whatever else the machine does;
thread CPU time does not, but the call that reads it does.
"""

from __future__ import annotations

import gc
import json
import platform
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from functools import cache
from pathlib import Path

import click
import numpy as np
from rich import box
from rich.console import Console
from rich.progress import track
from rich.table import Table

from tcs_hil.control.backend import Backend, chosen_backend
from tcs_hil.control.factory import make_controller
from tcs_hil.control.protocol import Controller, Proposal, WheelState
from tcs_hil.control.settings import ControlSettings, PresetName
from tcs_hil.model.bank import KoopmanBank, default_bank_path
from tcs_hil.model.predictor import KoopmanPredictor, default_model_path
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.signals import ControllerKind
from tests.control.believed_car import drive
from tests.control.quarter_car import manoeuvre_1, manoeuvre_2

MANOEUVRES: dict[PresetName, dict[str, Callable[[Controller], object]]] = {
    "paper": {"constant": manoeuvre_1, "varying": manoeuvre_2},
    "default": {"delayed": lambda controller: drive(controller, 3.0)},
}
PREDICTIVE = (ControllerKind.KMPC, ControllerKind.NMPC)
PAPER_US = {  # mean and maximum on the authors' PC, Table III
    ("KMPC", "constant"): (4.0, 43.2),
    ("KMPC", "varying"): (3.7, 62.7),
    ("NMPC", "constant"): (197.0, 600.0),
    ("NMPC", "varying"): (210.0, 507.0),
}


@dataclass
class Stopwatch:
    """A controller that times the one it wraps."""

    controller: Controller
    wall_ns: list[int] = field(default_factory=list)
    cpu_ns: list[int] = field(default_factory=list)

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        """Pass the call on, with the clocks as close around it as they get."""
        cpu = time.thread_time_ns()
        wall = time.perf_counter_ns()
        proposal = self.controller.step(wheel, torque_ref_nm)
        wall_end = time.perf_counter_ns()
        cpu_end = time.thread_time_ns()
        if torque_ref_nm > 0.0:
            self.wall_ns.append(wall_end - wall)
            self.cpu_ns.append(cpu_end - cpu)
        return proposal

    def reset(self) -> None:
        """Pass the call on."""
        self.controller.reset()


@dataclass(frozen=True)
class Statistics:
    """Of one kind of time over all steps, in microseconds."""

    mean_us: float
    p50_us: float
    p99_us: float
    max_us: float

    @classmethod
    def of(cls, times_ns: list[int]) -> Statistics:
        """Statistics of a list of nanoseconds."""
        times_us = np.array(times_ns) / 1e3
        p50, p99 = np.percentile(times_us, (50, 99))
        figures = (times_us.mean(), p50, p99, times_us.max())
        return cls(*(round(float(figure), 2) for figure in figures))


@dataclass(frozen=True)
class Row:
    """One controller along one manoeuvre."""

    controller: str
    preset: str
    backend: str
    manoeuvre: str
    steps: int
    wall: Statistics
    cpu: Statistics
    paper_mean_us: float | None
    paper_max_us: float | None


@dataclass(frozen=True)
class Law:
    """A law and the code that runs it."""

    kind: ControllerKind
    preset: PresetName
    backend: Backend

    def make(self) -> Controller:
        """A fresh controller."""
        settings = ControlSettings(preset=self.preset, backend=self.backend)
        return make_controller(self.kind, settings, Vehicle(), model(self.preset))


@cache
def model(preset: PresetName) -> KoopmanPredictor | KoopmanBank:
    """The shipped model file that a preset needs."""
    period_s = ControlSettings().period_s
    if preset == "paper":
        return KoopmanPredictor.load(default_model_path(), period_s)
    return KoopmanBank.load(default_bank_path(), period_s)


def measure(law: Law, manoeuvre: str, runs: int) -> Row:
    """Drive the manoeuvre ``runs`` times, each from a fresh controller."""
    wall_ns: list[int] = []
    cpu_ns: list[int] = []
    for _ in range(runs):
        watch = Stopwatch(law.make())
        MANOEUVRES[law.preset][manoeuvre](watch)
        wall_ns += watch.wall_ns
        cpu_ns += watch.cpu_ns
    paper = PAPER_US.get((law.kind.name, manoeuvre), (None, None))
    wall, cpu = Statistics.of(wall_ns), Statistics.of(cpu_ns)
    return Row(law.kind.name, law.preset, law.backend, manoeuvre, len(wall_ns), wall, cpu, *paper)


def laws() -> list[Law]:
    """Every law in Python, and native where that exists."""
    kinds: list[tuple[ControllerKind, PresetName]] = [(kind, "paper") for kind in ControllerKind]
    kinds += [(kind, "default") for kind in PREDICTIVE]
    return [
        Law(kind, preset, backend)
        for kind, preset in kinds
        for backend in dict.fromkeys(
            (chosen_backend(kind, ControlSettings(preset=preset)), "python")
        )
    ]


def machine() -> str:
    """Processor and interpreter, for the head of the table."""
    cpuinfo = Path("/proc/cpuinfo")
    lines = cpuinfo.read_text(encoding="utf-8").splitlines() if cpuinfo.exists() else []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    processor = names[0] if names else platform.machine()
    return f"{processor}, Python {platform.python_version()}"


def as_table(rows: list[Row]) -> Table:
    """Rows for people: wall time in full, CPU time by p50, the paper's by mean and max."""
    table = Table(
        title=f"Controller step in µs, {machine()}; * the default laws",
        box=box.SIMPLE_HEAD,
        padding=(0, 1, 0, 0),
    )
    for heading in ("law", "code", "run"):
        table.add_column(heading, no_wrap=True)
    for heading in ("mean", "p50", "p99", "max", "CPU", "paper"):
        table.add_column(heading, justify="right", no_wrap=True)
    for row in rows:
        wall = row.wall
        figures = (wall.mean_us, wall.p50_us, wall.p99_us, wall.max_us, row.cpu.p50_us)
        known = row.paper_mean_us is not None
        paper = f"{row.paper_mean_us:g}/{row.paper_max_us:g}" if known else "-"
        mark = "*" if row.preset == "default" else ""
        names = (row.controller + mark, row.backend, row.manoeuvre)
        table.add_row(*names, *(f"{x:.2f}" if x < 1.0 else f"{x:.1f}" for x in figures), paper)
    return table


@click.command()
@click.option("--runs", type=click.IntRange(1), default=3, show_default=True, help="Per row.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON instead of a table.")
def main(runs: int, as_json: bool) -> None:
    """Time a step of every law."""
    work = [(law, name) for law in laws() for name in MANOEUVRES[law.preset]]
    gc.disable()  # as the service does in its loop
    progress = track(work, "measuring", console=Console(stderr=True), transient=True)
    rows = [measure(law, name, runs) for law, name in progress]
    if as_json:
        click.echo(json.dumps({"machine": machine(), "rows": [asdict(row) for row in rows]}))
    else:
        Console().print(as_table(rows))


if __name__ == "__main__":
    main()
