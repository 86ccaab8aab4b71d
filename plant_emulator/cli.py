"""The command line: argv to scenario, bus and pace."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, NoReturn, cast

import click
import msgspec

from plant_emulator.scenario import Variant, list_scenarios, load_scenario
from plant_emulator.session import Options, Summary, run
from tcs_hil.errors import TcsError

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
    "--phase-us", default=0, help="Shift of the 2 ms grid against the monotonic clock's, in us."
)
@click.option("--interface", default="auto", show_default=True, help="As in python-can, or `auto`.")
@click.option("--channel", default="vcan0", show_default=True, help="As in python-can.")
@click.option("--bitrate", default=None, type=int, help="As in python-can.")
@click.option(
    "--record", type=click.Path(path_type=Path), help="Write the truth to this .npz file."
)
@click.option("--json", "as_json", is_flag=True, help="Print the summary as JSON.")
def run_command(scenario: str, vehicle: str | None, as_json: bool, **options: Any) -> None:
    """Drive a scenario on a CAN bus, in real time or in lockstep with the service."""
    plan = load_scenario(scenario)
    if vehicle is not None:
        plan = plan.with_variant(cast(Variant, vehicle))
    summary = run(plan, Options(**options), _stop_on_signal(), _say)
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
    """Run the command line; a user's mistake is one sentence on stderr and exit status 2."""
    try:
        cli.main(prog_name="plant-emulator", standalone_mode=False)
    except click.exceptions.Exit as done:
        sys.exit(done.exit_code)
    except click.ClickException as error:
        _refuse(error.format_message())
    except click.Abort:
        _refuse("interrupted")
    except TcsError as error:
        _refuse(str(error))


def _refuse(sentence: str) -> NoReturn:
    click.echo(f"plant-emulator: error: {sentence}", err=True)
    sys.exit(2)


def _say(line: str) -> None:
    click.echo(line, err=True)


def _sentence(summary: Summary) -> str:
    return (
        f"{summary.time_s:.3f} s, {summary.distance_m:.2f} m, {summary.speed_mps * 3.6:.1f} km/h; "
        f"wake jitter p50 {summary.jitter_p50_us:.0f} us, p99 {summary.jitter_p99_us:.0f} us, "
        f"max {summary.jitter_max_us:.0f} us"
    )


def _stop_on_signal() -> Callable[[], bool]:
    """Let SIGTERM and SIGINT end the run at the next tick; returns the question to ask."""
    caught: list[int] = []
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda number, _: caught.append(number))
    return lambda: bool(caught)
