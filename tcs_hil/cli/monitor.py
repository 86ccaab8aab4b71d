"""``tcs-hil monitor``."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import click
import msgspec

from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.port import open_port
from tcs_hil.cli.options import bus_options
from tcs_hil.console import refuse
from tcs_hil.errors import ConfigError
from tcs_hil.hil.monitor.snapshot import Snapshot
from tcs_hil.hil.monitor.sources import BusSource, FlightSource, Source

ONCE_S = 1.0


@click.command()
@bus_options
@click.option(
    "--flight",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Follow this flight recording instead of a bus.",
)
@click.option("--control", is_flag=True, help="Drive an emulator started with --allow-control.")
@click.option("--once", is_flag=True, help="Listen for a second, print what was seen, and end.")
@click.option("--json", "as_json", is_flag=True, help="Like --once, as JSON.")
def command(
    flight: Path | None,
    *,
    control: bool,
    once: bool,
    as_json: bool,
    **bus: Any,
) -> None:
    """Watch a bus or a flight recording live; with --control, drive the emulator by keys.

    Example: tcs-hil monitor --channel vcan0 --control
    """
    said = {"control": control, **bus}
    if flight is not None:
        refuse(said, said, "--flight has no bus to choose and nobody to control")
    if once or as_json:
        refuse(said, ["control"], "a look of a second gives no keys to press")
    source = FlightSource(flight) if flight is not None else _bus_source(in_control=control, **bus)
    try:
        if once or as_json:
            _print(_look_once(source, flight), as_json=as_json)
        else:
            _show(source, in_control=control)
    finally:
        source.close()


def _bus_source(
    interface: str | None, channel: str | None, bitrate: int | None, *, in_control: bool
) -> BusSource:
    port, description = open_port(interface or "auto", channel or "vcan0", bitrate)
    name, _, _ = description.partition(" (")  # why it was chosen does not matter here
    return BusSource(port, name, load_database(), in_control=in_control)


def _show(source: Source, *, in_control: bool) -> None:
    try:
        from tcs_hil.hil.monitor.view import Monitor  # noqa: PLC0415 - textual is an extra
    except ModuleNotFoundError as error:
        raise ConfigError("the live view needs textual: pip install 'tcs-hil[bench]'") from error
    failure = Monitor(source, in_control=in_control).run()
    if failure is not None:
        raise failure


def _look_once(source: Source, flight: Path | None) -> Snapshot:
    if flight is None:
        time.sleep(ONCE_S)  # rates and cycle times need a while
    snapshot, _ = source.look()
    if snapshot is None:
        raise ConfigError(f"{flight}: no tick was made yet")
    return snapshot


def _print(snapshot: Snapshot, *, as_json: bool) -> None:
    if as_json:
        click.echo(msgspec.json.encode(snapshot).decode())
        return
    from rich.console import Console  # noqa: PLC0415

    from tcs_hil.hil.monitor import panels  # noqa: PLC0415

    console = Console()
    for part in (panels.head, panels.slip_numbers, panels.torque_numbers, panels.timing):
        console.print(part(snapshot))
