"""``tcs-hil replay``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click
from msgspec.structs import replace

from tcs_hil.cli.damage import INCOMPLETE, warn_of
from tcs_hil.cli.options import BUS_OPTIONS, bus_options, json_option
from tcs_hil.cli.progress import progress_bar
from tcs_hil.console import FiniteRange, counted, refuse
from tcs_hil.hil.logs.sources import Sources, find_sources
from tcs_hil.hil.replay.session import (
    Verdict,
    recorded_config,
    replay_in_process,
    replay_live,
)
from tcs_hil.hil.replay.story import as_dict, tell
from tcs_hil.service.settings import ServiceConfig, read_service

DIFFERENT = 1
"""Exit status where the service no longer says what it said."""


@click.command()
@click.argument("run", type=click.Path(path_type=Path), nargs=-1, required=True)
@click.option(
    "--config",
    "config_path",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Configuration of the service; without it the one in the run's folder.",
)
@click.option("--controller", type=click.Choice(["off", "pi", "kmpc", "nmpc"]))
@click.option("--preset", type=click.Choice(["paper", "default"]))
@click.option(
    "--tolerance-nm",
    type=FiniteRange(min=0.0),
    default=0.0,
    show_default=True,
    help="How far a torque limit may be from the recorded one.",
)
@click.option("--live", is_flag=True, help="Onto a bus on which a service runs, not in process.")
@bus_options
@json_option
def command(
    run: tuple[Path, ...], tolerance_nm: float, live: bool, as_json: bool, **options: Any
) -> int:
    """Let the service live through a recorded RUN again and show where it decides otherwise.

    RUN is a run's folder or its files: a bus log (.blf, .asc, candump's .log,
    .mf4) and, of a run in real time, its flight recording, which tells exactly
    when it ticked.

    Exit status: 0 nothing differs, 1 something does, 3 nothing does in what could be
    read of a damaged log, 2 a mistake in what was asked.

    Example: tcs-hil replay runs/demo/runs/manoeuvre-1-quarter-car-kmpc-paper-lockstep
    """
    if live:
        refuse(options, ("controller", "preset"), "the running service has a law of its own")
    else:
        refuse(options, BUS_OPTIONS, "only --live needs a bus")
    sources = find_sources(run)
    with progress_bar("replaying") as advance:
        advance(0.0)
        verdict = (replay_live if live else replay_in_process)(
            sources, _config(sources, live, options), tolerance_nm
        )
    warn_of(verdict.lost)
    _show(verdict, as_json)
    if not verdict.comparison.same:
        return DIFFERENT
    return INCOMPLETE if verdict.lost else 0


def _config(sources: Sources, live: bool, options: dict[str, Any]) -> ServiceConfig:
    path = options["config_path"]
    if path is not None:
        return _with_options(read_service(path), options)
    config = recorded_config(sources)
    if live:  # the run may have been recorded on another kind of bus
        config = replace(config, bus=replace(config.bus, interface="auto"))
    return _with_options(config, options)


def _with_options(config: ServiceConfig, options: dict[str, Any]) -> ServiceConfig:
    """The configuration with what was said on the command line put on top."""

    def said(*names: str) -> dict[str, Any]:
        return {name: options[name] for name in names if options[name] is not None}

    return replace(
        config,
        **said("controller"),
        control=replace(config.control, **said("preset")),
        bus=replace(config.bus, **said("interface", "channel", "bitrate")),
    )


def _show(verdict: Verdict, as_json: bool) -> None:
    ticks, grid, database, comparison, lost, other = verdict
    if as_json:
        laws = None if other is None else other._asdict()
        told = as_dict(ticks, comparison) | {"other_law": laws, "lost": lost}
        click.echo(json.dumps({"grid": grid.name.lower()} | told))
        return
    if other is not None:
        click.echo(f"recorded under {other.recorded}, replayed under {other.replayed}")
    click.echo(
        f"{counted(comparison.ticks, 'tick')} compared, found by {grid.value}; "
        f"{comparison.differing} differ; {_apart(comparison.largest_nm)}"
    )
    for line in tell(ticks, comparison, database):
        click.echo(line)


def _apart(largest_nm: float | None) -> str:
    if largest_nm is None:
        return "never both set a torque limit"
    return f"largest difference of two torque limits {largest_nm:.3g} Nm"
