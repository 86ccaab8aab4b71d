"""Figures of the demo, as the paper shows them: slip and torque over time, and the prediction."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tcs_hil.hil.metrics import Truth
from tcs_hil.model.evaluation import Comparison

mpl.use("Agg")

COLOURS = {"off": "0.55", "pi": "tab:green", "kmpc": "tab:orange", "nmpc": "tab:blue"}
PALE = 0.35
REFERENCE = {"color": "black", "linestyle": "--", "linewidth": 1.0}


class Line(NamedTuple):
    """One run in a figure."""

    controller: str
    preset: str
    truth: Truth


def save_slip_figure(path: Path, title: str, runs: Sequence[Line], reference: float) -> None:
    """Slip and motor torque of the left front wheel, one line per run.

    A law as published is drawn paler where its default stands beside it.  A
    dotted line is where a run's front wheels meet another friction.
    """
    figure = Figure(figsize=(8.0, 5.6), layout="constrained")
    slip, torque = figure.subplots(2, 1, sharex=True)
    presets = {run.preset for run in runs}
    for controller, preset, truth in runs:
        line: dict[str, Any] = {
            "color": COLOURS[controller],
            "linewidth": 1.3,
            "label": controller.upper(),
        }
        if len(presets) > 1:
            line |= {"alpha": PALE if preset == "paper" else 1.0}
            line |= {"label": f"{controller.upper()} {preset}"}
        slip.plot(truth["time_s"], truth["slip_ratio"][:, 0], **line)
        torque.plot(truth["time_s"], truth["motor_torque_nm"][:, 0], **line)
        _mark_friction_changes(slip, truth, COLOURS[controller])
    slip.axhline(reference, **REFERENCE)
    longest = max((run.truth for run in runs), key=len)
    torque.plot(longest["time_s"], longest["request_nm"], **REFERENCE, label="driver's request")
    slip.set(title=title, ylabel="slip ratio", ylim=(-0.02, _slip_top(runs)))
    torque.set(xlabel="time in s", ylabel="motor torque in Nm")
    figure.legend(*torque.get_legend_handles_labels(), loc="outside lower center", ncols=5)
    _finish(figure, path)


def save_prediction_figure(path: Path, comparison: Comparison) -> None:
    """The paper's figure 1: 100 open-loop steps of the predictor beside the wheel dynamics."""
    figure = Figure(figsize=(8.0, 6.4), layout="constrained")
    *states, torque = figure.subplots(4, 1, sharex=True)
    labels = ("slip speed in m/s", "wheel speed in rad/s", "slip ratio")
    time_ms = comparison.time_s * 1e3
    for axes, label, truth, prediction in zip(
        states, labels, comparison.truth.T, comparison.prediction.T, strict=True
    ):
        axes.plot(time_ms, truth, color="black", label="wheel dynamics")
        axes.plot(time_ms, prediction, color=COLOURS["kmpc"], linestyle="--", label="predictor")
        axes.set_ylabel(label)
    torque.step(time_ms[:-1], comparison.torque_nm, where="post", color="0.3")
    torque.set(xlabel="time in ms", ylabel="motor torque in Nm")
    figure.legend(*states[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    states[0].set_title("Prediction from 20 km/h and slip 0.1 under random torque")
    _finish(figure, path)


def _mark_friction_changes(axes: Axes, truth: Truth, colour: str) -> None:
    changes = np.flatnonzero(np.diff(truth["mu"][:, 0])) + 1
    for time_s in truth["time_s"][changes]:
        axes.axvline(time_s, color=colour, linestyle=":", linewidth=0.9)


def _slip_top(runs: Sequence[Line]) -> float:
    peak = max(float(run.truth["slip_ratio"][:, 0].max()) for run in runs)
    return max(1.1 * peak, 0.15)


def _finish(figure: Figure, path: Path) -> None:
    for axes in figure.axes:
        axes.grid(alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
    figure.align_ylabels()
    figure.savefig(path, dpi=130)
