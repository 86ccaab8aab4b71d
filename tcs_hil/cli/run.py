"""``tcs-hil run``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
from msgspec import to_builtins
from msgspec.structs import replace

from tcs_hil.cli.options import bus_options, json_option
from tcs_hil.cli.summary import show_summary
from tcs_hil.config import convert
from tcs_hil.console import refuse
from tcs_hil.service.daemon import serve
from tcs_hil.service.settings import ServiceConfig, read_service


@click.command()
@click.option(
    "--config",
    "config_path",
    type=click.Path(dir_okay=False, path_type=Path),
    help="TOML file; options given here win over it.",
)
@click.option("--controller", type=click.Choice(["off", "pi", "kmpc", "nmpc"]))
@click.option(
    "--preset",
    type=click.Choice(["paper", "default"]),
    help="paper: the laws as published; default: the laws for a real bus and driveline.",
)
@click.option(
    "--model", type=click.Path(dir_okay=False), help="Koopman predictor made by `tcs-hil identify`."
)
@bus_options
@click.option(
    "--trigger",
    type=click.Choice(["timer", "frame", "lockstep"]),
    help="timer: the 2 ms grid; frame: the rear wheel speeds; lockstep: a bench paces the ticks.",
)
@click.option("--phase-us", type=int, help="Shift of the 2 ms grid.")
@click.option("--spin-us", type=int, help="Wait awake this long before each point of the grid.")
@click.option("--priority", type=int, help="Of SCHED_FIFO, 1 to 99.")
@click.option("--cpu", type=int, help="Core to stay on.")
@click.option(
    "--flight-recording",
    "path",
    type=click.Path(dir_okay=False),
    help="Write every tick into this file.",
)
@json_option
def command(config_path: Path | None, as_json: bool, **options: Any) -> None:
    """Run the traction control service until SIGINT or SIGTERM, then sum the run up.

    Example: tcs-hil run --controller nmpc --channel vcan0 --flight-recording run.tcsrec
    """
    config = ServiceConfig() if config_path is None else read_service(config_path)
    show_summary(serve(_with_options(config, options), _say), as_json)


def _say(line: str) -> None:
    """On stderr, so that stdout holds the summary alone."""
    click.echo(line, err=True)


def _with_options(config: ServiceConfig, options: dict[str, Any]) -> ServiceConfig:
    """The configuration with what was said on the command line put on top."""

    def said(*names: str) -> dict[str, Any]:
        return {name: options[name] for name in names if options[name] is not None}

    merged = replace(
        config,
        **said("controller", "model"),
        control=replace(config.control, **said("preset")),
        bus=replace(config.bus, **said("interface", "channel", "bitrate")),
        tick=replace(config.tick, **said("trigger", "phase_us", "spin_us", "priority", "cpu")),
        recorder=replace(config.recorder, **said("path")),
    )
    _refuse_idle(merged, options)
    # Put together from parts that were never checked together: bounds are looked at again.
    return convert(to_builtins(merged), ServiceConfig, "command line")


def _refuse_idle(config: ServiceConfig, options: dict[str, Any]) -> None:
    """Refuse what the law or the trigger of this run knows nothing of."""
    trigger = config.tick.trigger
    if config.controller != "kmpc":
        refuse(options, ["model"], f"the law is {config.controller}, and a predictor is kmpc's")
    if trigger != "timer":
        refuse(options, ["phase_us"], f"the trigger is {trigger}, and a grid is the timer's")
    if trigger == "lockstep":
        refuse(options, ["spin_us", "priority", "cpu"], "in lockstep the bench sets the pace")
