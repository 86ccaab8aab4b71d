"""The demo's one table, as text for the screen and the page alike."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import asdict
from typing import Any

from tcs_hil.hil.demo import Outcome
from tcs_hil.hil.paper import SOLVE_TIMES
from tcs_hil.runtime.summary import Percentiles

_REPORTED = {("paper", *run): times for run, times in SOLVE_TIMES.items()}


def _slip(value: float) -> str:
    return f"{value:.4f}"


def _law(outcome: Outcome) -> str:
    solve = outcome.timing.solve
    return "-" if solve is None else f"{solve.mean_us:.1f} / {solve.max_us:.0f}"


def _paper(outcome: Outcome) -> str:
    reported = _REPORTED.get(
        (outcome.choice.preset, outcome.choice.manoeuvre, outcome.choice.controller)
    )
    return "-" if reported is None else f"{reported.mean_us:g} / {reported.max_us:g}"


def _in_real_time(times: Callable[[Outcome], Percentiles | None]) -> Callable[[Outcome], str]:
    """Percentiles that mean something only where a clock, not the bench, sets the pace."""

    def text(outcome: Outcome) -> str:
        found = times(outcome) if outcome.choice.mode == "real-time" else None
        if found is None:
            return "-"
        return " / ".join(
            f"{value:.0f}" for value in (found.p50_us, found.p99_us, found.p99_9_us, found.max_us)
        )

    return text


Columns = dict[str, Callable[[Outcome], str]]

RUN_COLUMNS: Columns = {
    "manoeuvre": lambda o: o.choice.manoeuvre,
    "car": lambda o: o.choice.car,
    "controller": lambda o: o.choice.controller.upper(),
    "preset": lambda o: o.choice.preset,
    "pace": lambda o: "real time" if o.choice.mode == "real-time" else "lockstep",
}
SLIP_COLUMNS: Columns = {
    "slip RMSE": lambda o: _slip(o.slip.rmse_ratio),
    "peak slip": lambda o: _slip(o.slip.peak_ratio),
    "final km/h": lambda o: f"{o.slip.final_speed_mps * 3.6:.1f}",
    "mean |dT/dt| Nm/s": lambda o: f"{o.slip.chatter_nmps:.0f}",
}
TIMING_COLUMNS: Columns = {
    "law mean / max µs": _law,
    "paper's mean / max µs": _paper,
    "latency p50 / p99 / p99.9 / max µs": _in_real_time(lambda o: o.timing.latency),
    "jitter p50 / p99 / p99.9 / max µs": _in_real_time(lambda o: o.timing.wake_jitter),
    "overruns": lambda o: str(o.timing.overruns) if o.choice.mode == "real-time" else "-",
}
COLUMNS: Columns = RUN_COLUMNS | SLIP_COLUMNS | TIMING_COLUMNS


def row(outcome: Outcome, columns: Columns = COLUMNS) -> list[str]:
    """One run's cells, in the order of ``columns``."""
    return [text(outcome) for text in columns.values()]


def markdown(outcomes: Iterable[Outcome]) -> str:
    """The whole table for a README."""
    lines = [list(COLUMNS), ["---"] * len(COLUMNS), *map(row, outcomes)]
    return "\n".join(
        f"| {' | '.join(cell.replace('|', '&#124;') for cell in line)} |" for line in lines
    )


def as_dict(outcome: Outcome) -> dict[str, Any]:
    """One run's figures as numbers, for JSON."""
    return {
        "manoeuvre": outcome.choice.manoeuvre,
        "car": outcome.choice.car,
        "controller": outcome.choice.controller,
        "preset": outcome.choice.preset,
        "pace": outcome.choice.mode,
        "slip": asdict(outcome.slip),
        "timing": outcome.timing.as_dict(),
    }
