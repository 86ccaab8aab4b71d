"""``tcs-hil export``."""

from __future__ import annotations

import json
from pathlib import Path

import click

from tcs_hil.cli.damage import INCOMPLETE, warn_of
from tcs_hil.cli.options import json_option
from tcs_hil.cli.progress import progress_bar
from tcs_hil.console import counted
from tcs_hil.errors import ConfigError
from tcs_hil.hil.export.formats import contents, writer_of
from tcs_hil.hil.export.gather import gather
from tcs_hil.hil.export.table import Run
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
@json_option
def command(run: tuple[Path, ...], output: Path, dbc: Path | None, as_json: bool) -> int:
    """Write a run in a format other tools open: decoded signals, telemetry and plant truth.

    RUN is a run's folder, or its files: a bus log (.blf, .asc, candump's .log,
    .mf4), a flight recording and a truth (.npz), all put on one time base in
    seconds since the start of the run.

    A log that is cut short or damaged is exported as far as it can be read; the
    exit status is then 3.

    Example: tcs-hil export runs/demo/runs/manoeuvre-1-quarter-car-kmpc-paper-lockstep -o drive.mf4
    """
    write = writer_of(output)
    sources = find_sources(run)
    if dbc is not None and sources.bus is None:
        raise ConfigError(f"--dbc {dbc}: there is no bus log to decode")
    with progress_bar("reading") as advance:
        advance(0.0)
        gathered = gather(sources, dbc)
        advance(0.5, f"writing {output}")
        write(output, gathered)
    warn_of(gathered.lost)
    _show(output, gathered, as_json)
    return INCOMPLETE if gathered.lost else 0


def _show(output: Path, run: Run, as_json: bool) -> None:
    held, start = contents(output, run), run.start.isoformat()
    if as_json:
        counts = {f"{what}s": count for what, count in held.items()}
        click.echo(json.dumps({"file": str(output), "start": start, **counts, "lost": run.lost}))
        return
    words = ", ".join(counted(count, what) for what, count in held.items())
    click.echo(f"{output}: {words}; starts {start}")
