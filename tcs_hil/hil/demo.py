"""The paper's experiment: both manoeuvres, every controller, between real processes on a bus."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import product
from pathlib import Path

from tcs_hil.canbus.bus import choose_interface, open_bus
from tcs_hil.hil.figures import save_prediction_figure, save_slip_figure
from tcs_hil.hil.metrics import SlipMetrics, Truth, slip_metrics
from tcs_hil.hil.paper import MANOEUVRES
from tcs_hil.hil.run import Mode, RunPlan, execute
from tcs_hil.model.evaluation import figure1
from tcs_hil.model.predictor import KoopmanPredictor, default_model_path
from tcs_hil.runtime.summary import Summary, summarise
from tcs_hil.service.settings import ServiceConfig

CONTROLLERS = ("off", "pi", "kmpc", "nmpc")
MODES: tuple[Mode, ...] = ("lockstep", "realtime")
VARIANT = "quarter-car"
"""The paper's own car: what a bus and a driveline do to its laws is another experiment."""

Progress = Callable[[float, str], None]


@dataclass(frozen=True, slots=True)
class Outcome:
    """One run and what came of it."""

    manoeuvre: str
    controller: str
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
        progress(done / len(plans), f"{plan.scenario} {plan.controller} in {plan.mode}")
        outcomes.append(_outcome(plan))
    return Demo(description, tuple(outcomes), _draw(folder, outcomes))


def _plans(folder: Path, interface: str, channel: str) -> Iterator[RunPlan]:
    for mode, manoeuvre, controller in product(MODES, MANOEUVRES, CONTROLLERS):
        run_folder = folder / "runs" / f"{manoeuvre}-{controller}-{mode}"
        yield RunPlan(manoeuvre, VARIANT, controller, mode, run_folder, interface, channel)


def _outcome(plan: RunPlan) -> Outcome:
    files = execute(plan)
    truth = files.read_truth()
    config = ServiceConfig()
    return Outcome(
        manoeuvre=plan.scenario,
        controller=plan.controller,
        mode=plan.mode,
        truth=truth,
        slip=slip_metrics(truth, config.control.slip_reference, config.vehicle),
        timing=summarise(files.read_flight()),
    )


def _draw(folder: Path, outcomes: list[Outcome]) -> dict[str, Path]:
    reference = ServiceConfig().control.slip_reference
    predictor = KoopmanPredictor.load(default_model_path(), ServiceConfig().control.period_s)
    figures = {}
    for manoeuvre, title in MANOEUVRES.items():
        path = folder / f"{manoeuvre}.png"
        save_slip_figure(path, title, _runs(outcomes, manoeuvre, ("kmpc", "nmpc")), reference)
        figures[f"{title}: the paper's two controllers"] = path
    path = folder / "comparison.png"
    runs = _runs(outcomes, "manoeuvre-1", CONTROLLERS)
    save_slip_figure(path, MANOEUVRES["manoeuvre-1"], runs, reference)
    figures["With and without control"] = path
    path = folder / "prediction.png"
    save_prediction_figure(path, figure1(predictor))
    figures["The Koopman predictor's prediction"] = path
    return figures


def _runs(
    outcomes: list[Outcome], manoeuvre: str, controllers: tuple[str, ...]
) -> dict[str, Truth]:
    """Lockstep runs by controller: the figures must not depend on the machine's mood."""
    return {
        outcome.controller: outcome.truth
        for outcome in outcomes
        if outcome.manoeuvre == manoeuvre
        and outcome.mode == "lockstep"
        and outcome.controller in controllers
    }
