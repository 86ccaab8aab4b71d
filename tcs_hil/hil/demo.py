"""The paper's experiment: both manoeuvres, every controller, between real processes on a bus."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from itertools import product
from pathlib import Path

from msgspec.structs import replace

from plant_emulator.scenario import Variant, load_scenario
from tcs_hil.canbus.bus import choose_interface, open_bus
from tcs_hil.control.settings import ControlSettings, PresetName
from tcs_hil.hil.figures import Line, save_prediction_figure, save_slip_figure
from tcs_hil.hil.metrics import SlipMetrics, Truth, slip_metrics
from tcs_hil.hil.paper import MANOEUVRES
from tcs_hil.hil.processes.program import ProcessError
from tcs_hil.hil.run import Mode, RunFiles
from tcs_hil.hil.suite.case import Case
from tcs_hil.hil.suite.result import Result
from tcs_hil.hil.suite.runner import Bench, run_case
from tcs_hil.model.evaluation import figure1
from tcs_hil.model.predictor import KoopmanPredictor, default_model_path
from tcs_hil.runtime.summary import Summary, summarise
from tcs_hil.service.settings import ControllerName, ServiceConfig

CONTROLLERS: tuple[ControllerName, ...] = ("off", "pi", "kmpc", "nmpc")
MODES: tuple[Mode, ...] = ("lockstep", "real-time")
QUARTER_CAR: Variant = "quarter-car"
WHOLE_CAR: Variant = "vehicle"
PREDICTIVE: tuple[ControllerName, ...] = ("kmpc", "nmpc")
PRESETS: tuple[PresetName, ...] = ("paper", "default")

Progress = Callable[[float, str], None]


@dataclass(frozen=True, slots=True)
class Choice:
    """What distinguishes one run from the others."""

    manoeuvre: str
    car: Variant
    controller: ControllerName
    preset: PresetName
    mode: Mode


@dataclass(frozen=True, slots=True)
class Outcome:
    """One run and what came of it."""

    choice: Choice
    result: Result
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
    choices, outcomes = list(_choices()), []
    for done, choice in enumerate(choices):
        case = _case(choice)
        progress(done / len(choices), f"{case.name} {choice.mode}")
        outcomes.append(_outcome(choice, case, Bench(choice.mode, folder, interface, channel)))
    return Demo(description, tuple(outcomes), _draw(folder, outcomes))


def _choices() -> Iterator[Choice]:
    """The paper's experiment, and its laws on a car with driveline, sensors and delay."""
    for mode, manoeuvre, controller in product(MODES, MANOEUVRES, CONTROLLERS):
        yield Choice(manoeuvre, QUARTER_CAR, controller, "paper", mode)
    for controller, preset in product(PREDICTIVE, PRESETS):
        yield Choice("manoeuvre-1", WHOLE_CAR, controller, preset, "lockstep")


def _case(choice: Choice) -> Case:
    """The demo shows what each law does, so only what always holds is judged."""
    control = ControlSettings(preset=choice.preset)
    config = ServiceConfig(controller=choice.controller, control=control)
    scenario = load_scenario(choice.manoeuvre).with_variant(choice.car)
    pace = "" if choice.mode == "lockstep" else f", {choice.mode}"
    name = f"{choice.manoeuvre}, {choice.car}{pace}"
    return Case("demo", name, replace(scenario, expect=()), config)


def _outcome(choice: Choice, case: Case, bench: Bench) -> Outcome:
    result = run_case(case, bench)
    if result.error:
        raise ProcessError(result.error)
    files = RunFiles(bench.case_folder(case.name))
    truth = files.read_truth()
    return Outcome(
        choice=choice,
        result=result,
        truth=truth,
        slip=slip_metrics(truth, case.config.control.slip_reference, case.config.vehicle),
        timing=summarise(files.read_flight()),
    )


def _draw(folder: Path, outcomes: list[Outcome]) -> dict[str, Path]:
    reference = ServiceConfig().control.slip_reference
    predictor = KoopmanPredictor.load(default_model_path(), ServiceConfig().control.period_s)
    in_lockstep = [outcome for outcome in outcomes if outcome.choice.mode == "lockstep"]
    figures = {}

    def draw(name: str, title: str, manoeuvre: str, car: str, controllers: Collection[str]) -> None:
        """Lockstep runs only: the figures must not depend on the machine's mood."""
        runs = [
            Line(outcome.choice.controller, outcome.choice.preset, outcome.truth)
            for outcome in in_lockstep
            if (outcome.choice.manoeuvre, outcome.choice.car) == (manoeuvre, car)
            and outcome.choice.controller in controllers
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
