"""Service and emulator for half an hour and more at 500 Hz: does anything grow, drift or leak?

    scripts/with-vcan --rw . -- python -m benchmarks.soak --write docs/soak.md
    python -m benchmarks.soak --minutes 2 --interface embedded --json

The car launches on a snowy hill, rolls to a stop and launches again, so that
the service goes through its states once every half a minute.  Times of a
machine that is shared or simulated are printed and not judged.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

import click

from benchmarks.options import json_option, write_option
from benchmarks.section import markdown, tell
from benchmarks.soak_samples import Footprint, Sample, Verdict, Watcher, judge
from tcs_hil.cli.progress import progress_bar
from tcs_hil.console import NAME, FiniteRange
from tcs_hil.errors import TcsError
from tcs_hil.runtime.recording import RecordingError

LAUNCH_S = 30.0
SAMPLE_S = 10.0
WARM_UP_RATIO = 0.15
ROWS = 12
START_LIMIT_S = 120.0
SCENARIO = """
description = "One launch after the other on a snowy hill"
duration_s = {duration_s}
start_speed_kmph = 0.0
[vehicle]
variant = "vehicle"
[[road]]
mu = 0.3
grade = 0.06
[driver]
request = [{points}]
"""
HEADINGS = (
    *("minute", "RSS service, MiB", "RSS emulator, MiB", "descriptors", "threads"),
    *("ticks", "active", "skipped", "lost frames", "jitter p50, µs", "p99, µs", "drift, ns"),
)


def scenario(duration_s: float) -> str:
    """The scenario file: ten seconds of full throttle in each thirty."""
    launches = range(int(duration_s / LAUNCH_S) + 1)
    shape = ((1.0, 0.0), (1.5, 250.0), (10.0, 250.0), (10.2, 0.0))
    points = (f"[{launch * LAUNCH_S + at_s}, {nm}]" for launch in launches for at_s, nm in shape)
    return SCENARIO.format(duration_s=duration_s, points=", ".join(points))


@contextmanager
def program(*arguments: str, log: Path) -> Iterator[subprocess.Popen[bytes]]:
    """A program as its user would start it, asked to end at the end."""
    with (
        log.open("wb") as output,
        subprocess.Popen([sys.executable, "-m", *arguments], stdout=output, stderr=output) as child,
    ):
        try:
            yield child
        finally:
            child.terminate()


def soak(
    minutes: float, bus: Sequence[str], controller: str, advance: Callable[..., None]
) -> list[Sample]:
    """Run both programs and look at them every ``SAMPLE_S``.

    Raises:
        TcsError: one of them has ended early; what it said is quoted.
    """
    with tempfile.TemporaryDirectory(prefix="tcs-hil-soak.") as name:
        folder = Path(name)
        drive, flight = folder / "hill.toml", folder / "flight"
        drive.write_text(scenario(minutes * 60.0 + START_LIMIT_S))
        service = ("tcs_hil", "run", "--controller", controller, "--flight-recording", str(flight))
        plant = ("plant_emulator", "run", "--scenario", str(drive))
        logs = {what: folder / f"{what}.log" for what in ("service", "emulator")}
        with (
            program(*service, *bus, log=logs["service"]) as tcs,
            program(*plant, *bus, log=logs["emulator"]) as car,
        ):
            try:
                return list(_samples(minutes * 60.0, tcs.pid, car.pid, Watcher(flight), advance))
            except (OSError, TcsError) as error:
                said = {what: log.read_text(errors="replace") for what, log in logs.items()}
                raise TcsError(f"the soak ended early ({error}): {said}") from error


def _samples(
    duration_s: float, tcs: int, car: int, watcher: Watcher, advance: Callable[..., None]
) -> Iterator[Sample]:
    _await_the_car(watcher, time.monotonic() + START_LIMIT_S)
    begin_s = due_s = time.monotonic()
    while due_s - begin_s <= duration_s:
        time.sleep(max(due_s - time.monotonic(), 0.0))
        at_s = due_s - begin_s
        if ticking := watcher.look():
            yield Sample(at_s, Footprint.of(tcs), Footprint.of(car), ticking)
        advance(at_s / duration_s, f"minute {at_s // 60.0:.0f}")
        due_s += SAMPLE_S


def _await_the_car(watcher: Watcher, limit_s: float) -> None:
    """Return once the service hears the emulator, whose start takes all of a small machine."""
    while time.monotonic() < limit_s:
        with suppress(RecordingError):  # the service has not begun one yet
            ticking = watcher.look()
            if ticking is not None and ticking.rx_frames:
                return
        time.sleep(1.0)
    raise TcsError(f"the service has heard no car within {START_LIMIT_S:g} s")


def table(samples: Sequence[Sample]) -> list[str]:
    """Some of the samples as rows, ticks added up over what lies between two of them."""
    step = max(-(-len(samples) // ROWS), 1)
    rows = [_row(samples[begin : begin + step]) for begin in range(0, len(samples), step)]
    return markdown(HEADINGS, rows)


def _row(samples: Sequence[Sample]) -> list[str]:
    newest, ticking = samples[-1], [sample.ticking for sample in samples]
    return [
        f"{newest.at_s / 60.0:.1f}",
        f"{newest.service.rss_kib / 1024:.2f}",
        f"{newest.emulator.rss_kib / 1024:.2f}",
        f"{newest.service.descriptors}",
        f"{newest.service.threads}",
        f"{sum(t.ticks for t in ticking)}",
        f"{sum(t.active for t in ticking)}",
        f"{sum(t.skipped for t in ticking)}",
        f"{ticking[-1].lost_frames}",
        f"{sorted(t.jitter_p50_us for t in ticking)[len(ticking) // 2]:.0f}",
        f"{max(t.jitter_p99_us for t in ticking):.0f}",
        f"{max(abs(t.drift_ns) for t in ticking)}",
    ]


def conclusion(samples: Sequence[Sample], verdict: Verdict, warm_up_s: float) -> list[str]:
    """The verdict in words."""
    ticks = sum(sample.ticking.ticks for sample in samples)
    newest = samples[-1].ticking
    return [
        "",
        f"**{'Flat' if verdict.flat else 'Not flat'}.** {ticks} ticks in "
        f"{samples[-1].at_s / 60.0:.1f} minutes, {_rate_hz(samples):.1f} a second; "
        f"after {warm_up_s / 60.0:.1f} minutes of warm-up "
        f"the service's memory changes by {verdict.growth_kib_per_h:+.0f} KiB an hour "
        f"(fitted; the limit is {verdict.GROWTH_MAX_KIB_PER_H:.0f}), descriptors are "
        f"{'constant' if verdict.descriptors_constant else 'not constant'}, threads "
        f"{'constant' if verdict.threads_constant else 'not constant'}; "
        f"the grid has drifted by {verdict.drift_ns} ns; {verdict.failures} ticks failed. "
        f"{newest.rx_frames} frames received, {newest.tx_frames} sent, {newest.lost_frames} lost, "
        f"{newest.bus_errors} bus errors, {newest.e2e_errors} E2E errors.",
    ]


def _rate_hz(samples: Sequence[Sample]) -> float:
    """Ticks a second from the first look to the last."""
    ticks = sum(sample.ticking.ticks for sample in samples[1:])
    return ticks / (samples[-1].at_s - samples[0].at_s)


@click.command()
@click.option("--minutes", type=FiniteRange(min=1.0), default=32.0, show_default=True)
@click.option("--interface", type=NAME, default="auto", show_default=True)
@click.option("--channel", type=NAME, default="vcan0", show_default=True)
@click.option("--controller", default="kmpc", show_default=True)
@json_option
@write_option
def main(
    *,
    minutes: float,
    interface: str,
    channel: str,
    controller: str,
    machine_readable: bool,
    write: Path | None,
) -> None:
    """Soak the service; exit status 1 if it is not flat."""
    bus = ("--interface", interface, "--channel", channel)
    with progress_bar("soaking") as advance:
        samples = soak(minutes, bus, controller, advance)
    warm_up_s = WARM_UP_RATIO * minutes * 60.0
    verdict = judge(samples, warm_up_s)
    lines = [*table(samples), *conclusion(samples, verdict, warm_up_s)]
    tell("benchmarks.soak", lines, write, samples if machine_readable else None)
    sys.exit(not verdict.flat)


if __name__ == "__main__":
    main()
