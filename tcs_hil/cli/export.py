"""``tcs-hil export``."""

from __future__ import annotations

from pathlib import Path

import click

from tcs_hil.cli.progress import progress_bar
from tcs_hil.hil.export.formats import writer_of
from tcs_hil.hil.export.gather import gather
from tcs_hil.hil.logs.sources import find_sources


@click.command()
@click.argument("run", type=click.Path(path_type=Path), nargs=-1, required=True)
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, path_type=Path),
    required=True,
    help="File to write: .mf4, .parquet, .csv, or .log (candump).",
)
@click.option(
    "--dbc",
    type=click.Path(dir_okay=False, path_type=Path),
    help="DBC to decode the frames with; without it this project's.",
)
def command(run: tuple[Path, ...], output: Path, dbc: Path | None) -> None:
    """Write a run in a format other tools open: decoded signals, telemetry and plant truth.

    RUN is a run's folder, or its files: a bus log (.blf, .asc, candump's .log,
    .mf4), a flight recording and a truth (.npz), all put on one time base in
    seconds since the start of the run.

    Example: tcs-hil export runs/demo/runs/manoeuvre-1-quarter-car-kmpc-paper-lockstep -o drive.mf4
    """
    write = writer_of(output)
    with progress_bar("reading") as advance:
        advance(0.0)
        gathered = gather(find_sources(run), dbc)
        advance(0.5, f"writing {output}")
        write(output, gathered)
    samples = sum(len(table.time_ns) for table in gathered.tables)
    click.echo(
        f"{output}: {samples} samples of {len(gathered.tables)} sources, "
        f"{len(gathered.frames)} frames; starts {gathered.start.isoformat()}"
    )
