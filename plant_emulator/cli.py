"""The command line: argv to scenario, bus and pace."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any, cast

import click
import msgspec

from plant_emulator.scenario import Variant, list_scenarios, load_scenario
from plant_emulator.session import Options, Summary, run
from tcs_hil import console
from tcs_hil.runtime.stop import StopRequest

RUN_EXAMPLE = """\b
Example:
  plant-emulator run --scenario manoeuvre-1 --interface socketcan --channel vcan0
"""


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(package_name="tcs-hil")
def cli() -> None:
    """A front-driven electric car on a CAN bus, for traction control to be tested against."""


@cli.command("run", epilog=RUN_EXAMPLE)
@click.option(
    "--scenario", required=True, metavar="NAME|FILE", help="Shipped scenario or TOML file."
)
@click.option(
    "--vehicle",
    type=click.Choice(["quarter-car", "vehicle"]),
    help="Drive the scenario with this car instead of its own.",
)
@click.option(
    "--mode",
    type=click.Choice(["realtime", "lockstep"]),
    default="realtime",
    show_default=True,
    help="Pace: a 2 ms grid of the monotonic clock, or the answers of `tcs-hil run`.",
)
@click.option(
    "--phase-us",
    type=click.IntRange(0, 2000),
    help="Shift of the 2 ms grid against the monotonic clock's, in us.",
)
@click.option(
    "--interface",
    type=console.NAME,
    default="auto",
    show_default=True,
    help="As in python-can, or `auto`.",
)
@click.option(
    "--channel", type=console.NAME, default="vcan0", show_default=True, help="As in python-can."
)
@click.option("--bitrate", type=click.IntRange(min=1), help="As in python-can; not SocketCAN's.")
@click.option(
    "--record", type=click.Path(path_type=Path), help="Write the truth to this .npz file."
)
@click.option(
    "--allow-control",
    is_flag=True,
    help="Obey whoever drives by hand: `tcs-hil monitor --control`.",
)
@click.option("--json", "as_json", is_flag=True, help="Print the summary as JSON.")
def run_command(scenario: str, vehicle: str | None, as_json: bool, **options: Any) -> None:
    """Drive a scenario on a CAN bus, in real time or in lockstep with the service."""
    if options["mode"] == "lockstep":
        console.refuse(options, ["phase_us"], "in lockstep there is no grid to shift")
    plan = load_scenario(scenario)
    if vehicle is not None:
        plan = plan.with_variant(cast(Variant, vehicle))
    said = {name: value for name, value in options.items() if value is not None}
    with StopRequest() as stop:
        summary = run(plan, Options(**said), stop.requested, _say)
    click.echo(msgspec.json.encode(summary).decode() if as_json else _sentence(summary))


LIST_EXAMPLE = """\b
Example:
  plant-emulator list --json
"""


@cli.command("list", epilog=LIST_EXAMPLE)
@click.option("--json", "as_json", is_flag=True, help="Print the list as JSON.")
def list_command(as_json: bool) -> None:
    """Name the scenarios that are shipped."""
    listings = list_scenarios()
    if as_json:
        click.echo(msgspec.json.encode(listings).decode())
        return
    width = max(len(listing.name) for listing in listings)
    for listing in listings:
        click.echo(f"{listing.name:{width}}  {listing.description}")


def main() -> None:
    """Entry point of ``plant-emulator``."""
    sys.exit(console.run(cli, "plant-emulator"))


def _say(line: str) -> None:
    click.echo(line, err=True)


def _sentence(summary: Summary) -> str:
    refused = summary.refused_controls
    ignored = f"; {refused} control frames ignored, see --allow-control" if refused else ""
    return (
        f"{summary.time_s:.3f} s, {summary.distance_m:.2f} m, {summary.speed_mps * 3.6:.1f} km/h; "
        f"wake jitter p50 {summary.jitter_p50_us:.0f} us, p99 {summary.jitter_p99_us:.0f} us, "
        f"max {summary.jitter_max_us:.0f} us{ignored}"
    )
