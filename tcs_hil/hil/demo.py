"""The paper's experiment: both manoeuvres, every controller, between real processes on a bus."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from itertools import product
from pathlib import Path

from tcs_hil.canbus.bus import choose_interface, open_bus
from tcs_hil.control.settings import PresetName
from tcs_hil.hil.figures import Line, save_prediction_figure, save_slip_figure
from tcs_hil.hil.metrics import SlipMetrics, Truth, slip_metrics
from tcs_hil.hil.paper import MANOEUVRES
from tcs_hil.hil.run import Mode, RunPlan, execute
from tcs_hil.model.evaluation import figure1
from tcs_hil.model.predictor import KoopmanPredictor, default_model_path
from tcs_hil.runtime.summary import Summary, summarise
from tcs_hil.service.settings import ServiceConfig

CONTROLLERS = ("off", "pi", "kmpc", "nmpc")
MODES: tuple[Mode, ...] = ("lockstep", "realtime")
QUARTER_CAR, WHOLE_CAR = "quarter-car", "vehicle"
PREDICTIVE = ("kmpc", "nmpc")
PRESETS: tuple[PresetName, ...] = ("paper", "default")

Progress = Callable[[float, str], None]


@dataclass(frozen=True, slots=True)
class Outcome:
    """One run and what came of it."""

    manoeuvre: str
    car: str
    controller: str
    preset: PresetName
    mode: Mode
    truth: Truth
    slip: SlipMetrics
    timing: Summary


@dataclass(frozen=True, slots=True)
class Demo:
    """All runs, and the figures drawn from them: title to file, in the order to show them."""

    bus: str
    outcomes: tuple[Outcome, ...]
    figures: dict[str, Path]


def run_demo(folder: Path, interface: str, channel: str | None, progress: Progress) -> Demo:
    """Run everything into ``folder``; ``progress`` hears of the share done and what is next.

    Without a ``channel`` it is vcan0 where that is a real interface, else one of
    the embedded bus that nobody else uses.

    Raises:
        TcsError: the bus cannot be opened or one of the programs failed.
    """
    if channel is None:
        found, _ = choose_interface(interface, "vcan0")
        channel = f"vcan-demo-{os.getpid()}" if found == "embedded" else "vcan0"
    bus, description = open_bus(interface, channel)
    bus.shutdown()
    plans = list(_plans(folder, interface, channel))
    outcomes = []
    for done, plan in enumerate(plans):
        progress(done / len(plans), f"{plan.scenario} {plan.vehicle} {plan.controller} {plan.mode}")
        outcomes.append(_outcome(plan))
    return Demo(description, tuple(outcomes), _draw(folder, outcomes))


def _plans(folder: Path, interface: str, channel: str) -> Iterator[RunPlan]:
    """The paper's experiment, and its laws on a car with driveline, sensors and delay."""

    def plan(manoeuvre: str, car: str, controller: str, preset: PresetName, mode: Mode) -> RunPlan:
        run_folder = folder / "runs" / f"{manoeuvre}-{car}-{controller}-{preset}-{mode}"
        return RunPlan(manoeuvre, car, controller, mode, run_folder, interface, channel, preset)

    for mode, manoeuvre, controller in product(MODES, MANOEUVRES, CONTROLLERS):
        yield plan(manoeuvre, QUARTER_CAR, controller, "paper", mode)
    for controller, preset in product(PREDICTIVE, PRESETS):
        yield plan("manoeuvre-1", WHOLE_CAR, controller, preset, "lockstep")


def _outcome(plan: RunPlan) -> Outcome:
    files = execute(plan)
    truth = files.read_truth()
    config = ServiceConfig()
    return Outcome(
        manoeuvre=plan.scenario,
        car=plan.vehicle,
        controller=plan.controller,
        preset=plan.preset,
        mode=plan.mode,
        truth=truth,
        slip=slip_metrics(truth, config.control.slip_reference, config.vehicle),
        timing=summarise(files.read_flight()),
    )


def _draw(folder: Path, outcomes: list[Outcome]) -> dict[str, Path]:
    reference = ServiceConfig().control.slip_reference
    predictor = KoopmanPredictor.load(default_model_path(), ServiceConfig().control.period_s)
    in_lockstep = [outcome for outcome in outcomes if outcome.mode == "lockstep"]
    figures = {}

    def draw(name: str, title: str, manoeuvre: str, car: str, controllers: Collection[str]) -> None:
        """Lockstep runs only: the figures must not depend on the machine's mood."""
        runs = [
            Line(outcome.controller, outcome.preset, outcome.truth)
            for outcome in in_lockstep
            if (outcome.manoeuvre, outcome.car) == (manoeuvre, car)
            and outcome.controller in controllers
        ]
        path = folder / f"{name}.png"
        save_slip_figure(path, MANOEUVRES[manoeuvre], runs, reference)
        figures[title] = path

    for manoeuvre, title in MANOEUVRES.items():
        draw(manoeuvre, f"{title}: the laws as published", manoeuvre, QUARTER_CAR, PREDICTIVE)
    draw("comparison", "With and without control", "manoeuvre-1", QUARTER_CAR, CONTROLLERS)
    for name in PREDICTIVE:
        title = f"{name.upper()} on a car with driveline, sensors and delay: published and default"
        draw(f"driveline-{name}", title, "manoeuvre-1", WHOLE_CAR, (name,))
    path = folder / "prediction.png"
    save_prediction_figure(path, figure1(predictor))
    figures["The Koopman predictor's prediction"] = path
    return figures
