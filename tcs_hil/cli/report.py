"""``tcs-hil report``."""

from __future__ import annotations

import json
from pathlib import Path

import click
import numpy as np
from numpy.typing import NDArray

from tcs_hil.cli.options import json_option
from tcs_hil.cli.summary import print_summary
from tcs_hil.cli.worst import print_worst
from tcs_hil.errors import ConfigError
from tcs_hil.runtime.histogram import hgrm
from tcs_hil.runtime.recording import read, read_info
from tcs_hil.runtime.summary import summarise
from tcs_hil.runtime.times import times_us
from tcs_hil.runtime.worst import worst_ticks


@click.command()
@click.argument("recording", type=click.Path(dir_okay=False, path_type=Path))
@click.option(
    "--worst",
    type=click.IntRange(min=0),
    default=0,
    metavar="N",
    help="Also list the N ticks that took longest, with what they were doing.",
)
@click.option(
    "--histograms",
    type=click.Path(file_okay=False, path_type=Path),
    help="Also write an HdrHistogram percentile table (.hgrm) of each time, in µs, to this folder.",
)
@json_option
def command(recording: Path, worst: int, histograms: Path | None, as_json: bool) -> None:
    """Show latency, jitter and states of a flight RECORDING, even while the service runs.

    Example: tcs-hil report --worst 10 run.tcsrec
    """
    ticks = read(recording)
    summary, bad_ticks = summarise(ticks), worst_ticks(ticks, worst)
    if histograms is not None:
        _write_histograms(histograms, ticks)
    if as_json:
        listed = {"worst": [tick.as_dict() for tick in bad_ticks]} if worst else {}
        click.echo(json.dumps(summary.as_dict() | listed))
        return
    info = read_info(recording)
    click.echo(f"{info.controller} ({info.backend}) on {info.bus}, {info.machine}")
    print_summary(summary)
    if worst:
        print_worst(bad_ticks)


def _write_histograms(folder: Path, ticks: NDArray[np.void]) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, samples_us in times_us(ticks).items():
            if len(samples_us):
                (folder / f"{name}.hgrm").write_text(hgrm(samples_us), encoding="ascii")
    except OSError as error:
        raise ConfigError(f"{error.filename}: cannot be written ({error.strerror})") from error
