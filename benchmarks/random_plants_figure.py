"""Where in the space of plants a campaign's bad runs lie."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.random_plants import Sample, Trial

mpl.use("Agg")

Value = Callable[[Sample], float]
PANELS: tuple[tuple[tuple[str, Value], tuple[str, Value]], ...] = (
    (
        ("start speed in km/h", lambda s: s.start_speed_kmph),
        ("lower of the two mu", lambda s: min(s.mu_before, s.mu_after)),
    ),
    (
        ("shaft stiffness in kNm/rad", lambda s: s.shaft_stiffness_nmprad * 1e-3),
        ("shaft damping in Nms/rad", lambda s: s.shaft_damping_nmsprad),
    ),
    (
        ("motor lag in ms", lambda s: s.motor_lag_s * 1e3),
        ("delay of the limit in ms", lambda s: s.limit_delay_s * 1e3),
    ),
    (
        ("relaxation length in m", lambda s: s.relaxation_m),
        ("teeth", lambda s: float(s.teeth)),
    ),
)
KINDS: dict[str, dict[str, Any]] = {
    "calm": {"marker": ".", "s": 22, "color": "0.7"},
    "limit cycle": {"marker": "o", "s": 26, "color": "tab:orange"},
    "slip > 0.6 for > 200 ms": {"marker": "X", "s": 44, "color": "tab:red"},
}


def save_campaign_figure(path: Path, title: str, trials: Sequence[Trial]) -> None:
    """Draw every plant in four views of the space, bad runs on top of calm ones."""
    figure = Figure(figsize=(9.0, 7.0), layout="constrained")
    for axes, (across, up) in zip(figure.subplots(2, 2).flat, PANELS, strict=True):
        for kind in KINDS:
            chosen = [trial.sample for trial in trials if _kind(trial) == kind]
            _scatter(axes, kind, [across[1](s) for s in chosen], [up[1](s) for s in chosen])
        axes.set(xlabel=across[0], ylabel=up[0])
        axes.grid(alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
    figure.suptitle(title)
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=len(KINDS))
    figure.savefig(path, dpi=130)


def _kind(trial: Trial) -> str:
    if trial.spins:
        return "slip > 0.6 for > 200 ms"
    return "limit cycle" if trial.oscillates else "calm"


def _scatter(axes: Axes, kind: str, across: list[float], up: list[float]) -> None:
    axes.scatter(across, up, label=kind, linewidths=0.0, **KINDS[kind])
