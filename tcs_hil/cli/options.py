"""Options that mean the same in every command."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

from tcs_hil.console import NAME
from tcs_hil.errors import ConfigError

BUS_OPTIONS = ("interface", "channel", "bitrate")
F = TypeVar("F", bound=Callable[..., Any])


def bus_options(function: F) -> F:
    """--interface, --channel, --bitrate as in python-can; None where the user said nothing."""
    function = click.option(
        "--bitrate",
        type=click.IntRange(min=1),
        help="Bit/s, for interfaces that take it; not SocketCAN's.",
    )(function)
    function = click.option("--channel", type=NAME, help="CAN channel, such as vcan0 or can0.")(
        function
    )
    return click.option(
        "--interface",
        type=NAME,
        help="python-can interface; auto takes SocketCAN, or the embedded bus for a vcan channel "
        "where the kernel has no SocketCAN.",
    )(function)


def json_option(function: F) -> F:
    """--json: the same figures for a program to read."""
    return click.option("--json", "as_json", is_flag=True, help="Print JSON instead of a table.")(
        function
    )


def check_folder(path: Path | None) -> None:
    """Refuse a file that could not be written once all the work is done.

    Raises:
        ConfigError: there is no folder for it, or it is one itself; the file is named.
    """
    if path is None:
        return
    if path.is_dir():  # which an empty name is, too
        raise ConfigError(f"{path}: is a folder, not a file to write")
    if not path.absolute().parent.is_dir():
        raise ConfigError(f"{path}: there is no such folder to write into")
