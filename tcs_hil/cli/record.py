"""``tcs-hil record``."""

from __future__ import annotations

from pathlib import Path

import click

from tcs_hil.canbus.bus import open_bus
from tcs_hil.cli.options import bus_options
from tcs_hil.hil.record import record
from tcs_hil.runtime.notify import notify
from tcs_hil.runtime.stop import StopRequest


@click.command()
@click.argument("file", type=click.Path(dir_okay=False, path_type=Path))
@bus_options
def command(file: Path, interface: str | None, channel: str | None, bitrate: int | None) -> None:
    """Record a bus into FILE until SIGINT or SIGTERM; .blf, .asc and .log (candump) by suffix.

    Example: tcs-hil record --channel vcan0 drive.blf
    """
    bus, description = open_bus(interface or "auto", channel or "vcan0", bitrate)
    click.echo(f"recording {description} into {file}")
    with bus, StopRequest() as stop:
        count = record(bus, file, stop.requested, lambda: notify("READY=1"))
    click.echo(f"{count} frames")
