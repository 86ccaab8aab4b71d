"""``tcs-hil metrics``."""

from __future__ import annotations

import time
from pathlib import Path

import click
from prometheus_client import CollectorRegistry, start_http_server

from tcs_hil.errors import ConfigError
from tcs_hil.runtime.exporter import FlightCollector
from tcs_hil.runtime.follower import Follower
from tcs_hil.runtime.notify import notify
from tcs_hil.runtime.recording import read_info
from tcs_hil.runtime.stop import StopRequest

STOP_POLL_S = 0.1
PORT_MAX = 65_535
BEGIN = 8
"""Bytes of a recording that are zero until its header is whole."""


@click.command()
@click.argument("recording", type=click.Path(dir_okay=False, path_type=Path))
@click.option(
    "--listen",
    default="127.0.0.1:9555",
    show_default=True,
    metavar="HOST:PORT",
    help="Where Prometheus may ask; port 0 takes a free one.",
)
def command(recording: Path, listen: str) -> None:
    """Serve Prometheus metrics of the service that writes the flight RECORDING.

    A process of its own: the service does not know of it. The recording may come
    later, end, or be replaced by that of the next run.

    Example: tcs-hil metrics /dev/shm/flight --listen 127.0.0.1:9555
    """
    host, port = _address(listen)
    _refuse_foreign(recording)
    registry = CollectorRegistry()
    registry.register(FlightCollector(Follower(recording), time.monotonic_ns))
    try:
        server, thread = start_http_server(port, host, registry)
    except OSError as error:
        raise ConfigError(f"--listen {listen}: cannot listen ({error.strerror})") from error
    click.echo(f"http://{host}:{server.server_port}/metrics")
    with StopRequest() as stop:
        notify("READY=1")
        while not stop.requested():
            thread.join(STOP_POLL_S)
    server.shutdown()
    server.server_close()


def _refuse_foreign(path: Path) -> None:
    """Refuse what will never be a flight recording; one that is still to come is none."""
    try:
        with path.open("rb") as file:
            begin = file.read(BEGIN)
    except FileNotFoundError:
        return
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read ({error.strerror})") from error
    if begin.strip(b"\0"):  # else the service is just making it
        read_info(path)


def _address(listen: str) -> tuple[str, int]:
    host, _, port = listen.rpartition(":")
    if not host or not port.isdecimal() or int(port) > PORT_MAX:
        raise ConfigError(f"--listen {listen}: is not HOST:PORT")
    return host, int(port)
