"""Success over the space: every axis against every other, failures on top."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from tcs_hil.hil.study.plan import Axis, Study
from tcs_hil.hil.study.trial import Row

mpl.use("Agg")

BINS = 8
TICKS = 5
MOST_PANELS = 12
KEPT: dict[str, Any] = {"marker": ".", "s": 40, "color": "0.55", "label": "success"}
BROKEN: dict[str, Any] = {"marker": "o", "s": 26, "color": "tab:red", "label": "no success"}


def save_study_figure(path: Path, study: Study, rows: Sequence[Row]) -> None:
    """Left, the share of successes along each axis; right, runs over an axis and the next."""
    axes_of = study.vary[:MOST_PANELS]
    figure = Figure(figsize=(9.0, 2.6 * len(axes_of)), layout="constrained")
    panels = np.atleast_2d(figure.subplots(len(axes_of), 2, squeeze=False))
    partners = dict(pairwise(axes_of)) | {axes_of[-1]: axes_of[0]}
    for (left, right), axis in zip(panels, axes_of, strict=True):
        _share_along(left, axis, rows)
        _runs_over(right, axis, partners[axis], rows)
    figure.suptitle(study.description or f"{len(rows)} runs of {study.scenario}")
    figure.legend(*panels[0][1].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    figure.savefig(path, dpi=120)


def _share_along(panel: Axes, axis: Axis, rows: Sequence[Row]) -> None:
    success = np.array([float(row["success"]) for row in rows])
    if axis.values:
        names = [str(value) for value in axis.values]
        chosen = [np.array([str(row[axis.key]) == name for row in rows]) for name in names]
        panel.bar(
            names, [float(success[c].mean()) if c.any() else 0.0 for c in chosen], color="0.6"
        )
    else:
        values = np.array([float(row[axis.key]) for row in rows])
        edges = np.linspace(float(axis.low or 0), float(axis.high or 0), BINS + 1)
        place = np.clip(np.digitize(values, edges) - 1, 0, BINS - 1)
        share = [success[place == b].mean() if (place == b).any() else np.nan for b in range(BINS)]
        panel.stairs(np.array(share, float), edges, fill=True, color="0.6")
        panel.xaxis.set_major_locator(MaxNLocator(TICKS))
    panel.set(xlabel=axis.key, ylabel="share of success", ylim=(0.0, 1.02))
    _tidy(panel)


def _runs_over(panel: Axes, across: Axis, up: Axis, rows: Sequence[Row]) -> None:
    for style, wanted in ((KEPT, True), (BROKEN, False)):
        chosen = [row for row in rows if row["success"] is wanted]
        panel.scatter(
            [_number(row[across.key]) for row in chosen],
            [_number(row[up.key]) for row in chosen],
            linewidths=0.0,
            **style,
        )
    if not across.values:
        panel.xaxis.set_major_locator(MaxNLocator(TICKS))
    panel.set(xlabel=across.key, ylabel=up.key)
    _tidy(panel)


def _number(value: Any) -> Any:
    return value if isinstance(value, (int, float)) and not isinstance(value, bool) else str(value)


def _tidy(panel: Axes) -> None:
    panel.grid(alpha=0.3)
    panel.spines[["top", "right"]].set_visible(False)
