"""The result as Markdown: for a terminal, and for the README."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from statistics import median

from tcs_hil.hil.bench.bus import BusRow
from tcs_hil.hil.bench.controllers import ControllerRow
from tcs_hil.hil.bench.result import Result
from tcs_hil.hil.bench.scaling import ScalingRow
from tcs_hil.hil.bench.start import StartRow
from tcs_hil.hil.bench.statistics import Statistics
from tcs_hil.hil.bench.tick import STAGES, TickRow
from tcs_hil.hil.section import markdown

ABSENT = "-"


def page(result: Result) -> Iterator[str]:
    """Lines: a heading, a sentence and a table for every part that ran."""
    if result.controllers:
        yield from _controllers(result.controllers)
    if result.tick:
        yield from _ticks(result.tick)
    if result.scaling:
        yield from _scaling(result.scaling)
    if result.bus:
        yield from _bus(result.bus)
    if result.start:
        yield from _starts(result.start)
    yield f"On {result.conditions}."


def _controllers(rows: Sequence[ControllerRow]) -> Iterator[str]:
    yield from _opening(
        "Controller step",
        "One step of one wheel, called from Python, in µs. ΔT is the largest deviation from IPOPT "
        "(NMPC) or daqp (KMPC) on the published problems; the paper's times are its authors', on "
        "their PC.",
    )
    names, times = ("law", "preset", "by", "run", "steps"), ("mean", "p50", "p99", "max")
    others = ("CPU p50", "CPU p99", "paper mean / max", "ΔT Nm")
    yield from markdown((*names, *times, *others), map(_controller, rows))
    yield ""


def _controller(row: ControllerRow) -> tuple[str, ...]:
    names = (row.law, row.preset, row.code, row.manoeuvre)
    paper = f"{row.paper.mean_us:g} / {row.paper.max_us:g}" if row.paper else ABSENT
    if row.cost is None:
        return (*names, "not installed", *[ABSENT] * 6, paper, ABSENT)
    wall, cpu = row.cost.wall, row.cost.cpu
    figures = (wall.mean_us, wall.p50_us, wall.p99_us, wall.max_us, cpu.p50_us, cpu.p99_us)
    deviation = ABSENT if row.deviation_nm is None else f"{row.deviation_nm:.0e}"
    return (*names, str(wall.samples), *map(_us, figures), paper, deviation)


def _ticks(rows: Sequence[TickRow]) -> Iterator[str]:
    yield from _opening(
        "Whole tick",
        "From the frames' bytes to the frames' bytes and the flight record, both wheels, without "
        "the bus and the kernel, in µs. Stages are medians; `solve` is one wheel's law, a part of "
        "`step`. Vehicles per core leave half of every 2 ms free at the tick's p99.9.",
    )
    headings = ("law", "preset", "by", "p50", "p99", "p99.9", "CPU p50", "CPU p99", "CPU p99.9")
    yield from markdown((*headings, *STAGES, "vehicles"), map(_tick, rows))
    yield ""


def _tick(row: TickRow) -> tuple[str, ...]:
    whole = row.cost.whole
    times = [(side.p50_us, side.p99_us, side.p99_9_us) for side in (whole.wall, whole.cpu)]
    figures = (*times[0], *times[1], *(row.cost.stages[stage].p50_us for stage in STAGES))
    return (row.law, row.preset, row.code, *map(_us, figures), str(row.vehicles_per_core))


def _scaling(rows: Sequence[ScalingRow]) -> Iterator[str]:
    yield from _opening(
        "Horizon and order",
        "Median CPU time of a step of the published laws, in µs, as the horizon N or the order of "
        "the lifting grows (published: 5 and 4).",
    )
    lines = []
    for (law, code, axis), group in groupby(rows, key=lambda row: (row.law, row.code, row.axis)):
        steps = "  ".join(f"{row.value}: {_us(row.cost.cpu.p50_us)}" for row in group)
        lines.append((law, code, axis, steps))
    yield from markdown(("law", "by", "varied", "value: µs"), lines)
    yield ""


def _bus(rows: Sequence[BusRow]) -> Iterator[str]:
    for row in rows:
        without = f", without {', '.join(row.without)}" if row.without else ""
        yield from _opening(
            "On a bus",
            f"{row.law} on the {row.bus} bus beside the plant and a recorder, {row.ticks} ticks"
            f"{without}: {row.late} late, {row.skipped} skipped, {row.lost_frames} frames lost; "
            f"p99.9 of the wake jitter is {row.jitter_ratio:.2f} times that of a process that only "
            "wakes. In µs:",
        )
        yield from markdown(("", "p50", "p99", "p99.9", "max"), _bus_lines(row))
        yield ""


def _bus_lines(row: BusRow) -> Iterator[tuple[str, ...]]:
    for name, times in (
        ("wake jitter without the service", row.baseline),
        ("wake jitter", row.jitter),
        ("wake to sent", row.tick),
        ("newest wheel speed to sent", row.latency),
    ):
        yield name, *_distribution(times)


def _starts(rows: Sequence[StartRow]) -> Iterator[str]:
    yield from _opening(
        "Start", "From a fresh interpreter to the first tick on record, in s, on the embedded bus."
    )
    lines = [
        (r.law, r.preset, r.code, f"{median(r.seconds):.2f}", f"{max(r.seconds):.2f}") for r in rows
    ]
    yield from markdown(("law", "preset", "by", "median", "max"), lines)
    yield ""


def _opening(title: str, sentence: str) -> tuple[str, ...]:
    return f"**{title}.** {sentence}", ""


def _distribution(times: Statistics) -> Iterator[str]:
    return map(_us, (times.p50_us, times.p99_us, times.p99_9_us, times.max_us))


def _us(time_us: float) -> str:
    """Two digits below 10 µs, where they are worth something."""
    return f"{time_us:.2f}" if time_us < 10.0 else f"{time_us:.0f}"
