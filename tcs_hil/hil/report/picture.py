"""What the report shows of one run, kept beside the run: traces, faults, limits, times."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from tcs_hil.hil.judging.channels import namespace
from tcs_hil.hil.judging.evidence import Evidence, Series
from tcs_hil.hil.judging.of_run import stretch
from tcs_hil.hil.report.pack import Packed, pack
from tcs_hil.runtime.times import times_us
from tcs_hil.runtime.worst import worst_ticks

FILE = "picture.json"

KMPH = 3.6
BINS = 60
WORST = 8
SHOWN = (
    *("truth.slip_ratio_fl", "truth.slip_ratio_fr"),
    *("service.slip_ratio_fl", "service.slip_ratio_fr"),
    "truth.request_nm",
    *("service.limit_fl_nm", "service.limit_fr_nm"),
    *("truth.motor_torque_fl_nm", "truth.motor_torque_fr_nm"),
    *("truth.mu_fl", "truth.mu_fr"),
    "service.state",
)
"""Channels every report shows, besides speeds and those that are limited."""


class Span(msgspec.Struct, frozen=True):
    """A fault, from when to when; without an end it lasts."""

    label: str
    from_s: float
    to_s: float | None


class Line(msgspec.Struct, frozen=True):
    """A limit that can be drawn: on which channels, at which value, in which window."""

    channels: list[str]
    op: str
    value: float
    from_s: float
    to_s: float | None


class Histogram(msgspec.Struct, frozen=True):
    """Counts of a time of the service between ``low_us`` and ``high_us``, in bins of one width."""

    what: str
    low_us: float
    high_us: float
    counts: list[int]


class Picture(msgspec.Struct, frozen=True, kw_only=True):
    """Everything the page draws of one run; ``labels`` name the values of a channel."""

    traces: Packed
    units: dict[str, str]
    labels: dict[str, dict[str, float]]
    reference: float
    faults: list[Span]
    limits: list[Line]
    histogram: Histogram | None
    worst: list[dict[str, Any]]


def take(evidence: Evidence) -> Picture:
    """Draw everything from a run's files."""
    extra = [name for name in _limited(evidence) if name not in SHOWN]
    names = dict.fromkeys((*SHOWN, *extra))
    found = namespace(evidence.config.bus.database)
    chosen = {name: found.find(name) for name in names}
    time_s = evidence.truth["time_s"]
    traces = {name: _on(time_s, evidence.series(each)) for name, each in chosen.items()}
    return Picture(
        traces=pack(time_s, traces | _speeds_kmph(evidence)),
        units={name: each.unit for name, each in chosen.items()},
        labels={name: dict(each.labels) for name, each in chosen.items() if each.labels},
        reference=evidence.config.control.slip_reference,
        faults=[
            Span(f"{fault.target} {fault.kind}", fault.start_s, fault.end_s)
            for fault in evidence.scenario.fault
        ],
        limits=list(_lines(evidence)),
        histogram=_histogram(evidence),
        worst=list(_worst(evidence)),
    )


def save(picture: Picture, folder: Path) -> None:
    """Keep it with the other files of the run."""
    (folder / FILE).write_bytes(msgspec.json.encode(picture))


def _on(time_s: NDArray[np.float64], series: Series) -> NDArray[np.float64]:
    """A channel at other times: the newest sample holds."""
    newest = np.searchsorted(series.time_s, time_s + 1e-9, side="right") - 1
    values = np.append(series.values, np.nan)  # -1, before the first sample, is the last
    return np.asarray(values[newest])


def _speeds_kmph(evidence: Evidence) -> dict[str, NDArray[np.float64]]:
    """Car and driven wheels, as a driver would read them."""
    truth, radius_m = evidence.truth, evidence.config.vehicle.wheel_radius_m
    wheels_kmph = truth["wheel_speed_radps"] * radius_m * KMPH
    car = {"car": truth["speed_mps"] * KMPH}
    return car | {"wheel fl": wheels_kmph[:, 0], "wheel fr": wheels_kmph[:, 1]}


def _limited(evidence: Evidence) -> Iterator[str]:
    """Full names of the channels the scenario puts a limit on."""
    found = namespace(evidence.config.bus.database)
    for expect in evidence.scenario.expect:
        if expect.signal is not None:
            yield str(found.find(expect.signal))


def _lines(evidence: Evidence) -> Iterator[Line]:
    found = namespace(evidence.config.bus.database)
    for expect in evidence.scenario.expect:
        if not isinstance(expect.value, float):
            continue
        window = (expect.op, expect.value, expect.from_s, expect.to_s)
        if expect.metric == "peak slip":
            yield Line(["truth.slip_ratio_fl", "truth.slip_ratio_fr"], *window)
        elif expect.signal is not None and expect.metric in (None, "peak", "lowest"):
            yield Line([str(found.find(expect.signal))], *window)


def _worst(evidence: Evidence) -> Iterator[dict[str, Any]]:
    """The slowest ticks of the run, at the time of the plant."""
    run = stretch(evidence, 0.0, np.inf)
    at_s = dict(zip(run.ticks["number"].tolist(), run.tick_time_s.tolist(), strict=True))
    for tick in worst_ticks(run.ticks, WORST):
        yield tick.as_dict() | {"at_s": at_s[tick.number]}


def _histogram(evidence: Evidence) -> Histogram | None:
    """Latency where a clock set the pace, else what a control law took."""
    name, what = ("latency", "latency") if evidence.clocked else ("solve", "control law, per wheel")
    samples_us = times_us(stretch(evidence, 0.0, np.inf).ticks)[name]
    if not samples_us.size:
        return None
    counts, edges = np.histogram(samples_us, BINS)
    return Histogram(what, float(edges[0]), float(edges[-1]), counts.tolist())
