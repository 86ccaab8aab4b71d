"""``tcs-hil replay``."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click
from msgspec.structs import replace

from tcs_hil.cli.options import bus_options, json_option
from tcs_hil.cli.progress import progress_bar
from tcs_hil.hil.logs.sources import find_sources
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
    type=click.FloatRange(min=0.0),
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
    when it ticked.  The exit status is 1 where something differs.

    Example: tcs-hil replay runs/demo/runs/manoeuvre-1-quarter-car-kmpc-paper-lockstep
    """
    sources = find_sources(run)
    path = options.pop("config_path")
    config = recorded_config(sources) if path is None else read_service(path)
    if live:  # the run may have been recorded on another kind of bus
        config = replace(config, bus=replace(config.bus, interface="auto"))
    with progress_bar("replaying") as advance:
        advance(0.0)
        verdict = (replay_live if live else replay_in_process)(
            sources, _with_options(config, options), tolerance_nm
        )
    _show(verdict, as_json)
    return 0 if verdict.comparison.same else DIFFERENT


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
    ticks, grid, database, comparison = verdict
    if as_json:
        click.echo(json.dumps({"grid": grid.name.lower()} | as_dict(ticks, comparison)))
        return
    click.echo(
        f"{comparison.ticks} ticks compared, found by {grid.value}; {comparison.differing} differ; "
        f"largest difference of a torque limit {comparison.largest_nm:.3g} Nm"
    )
    for line in tell(ticks, comparison, database):
        click.echo(line)
