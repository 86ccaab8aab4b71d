"""Options that mean the same in every command."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, TypeVar

import click

from tcs_hil.errors import ConfigError

BUS_OPTIONS = ("interface", "channel", "bitrate")
F = TypeVar("F", bound=Callable[..., Any])


def bus_options(function: F) -> F:
    """--interface, --channel, --bitrate as in python-can; None where the user said nothing."""
    function = click.option(
        "--bitrate", type=click.IntRange(min=1), help="Bit/s, for interfaces that take it."
    )(function)
    function = click.option("--channel", help="CAN channel, such as vcan0 or can0.")(function)
    return click.option(
        "--interface",
        help="python-can interface; auto takes SocketCAN, or the embedded bus for a vcan channel "
        "where the kernel has no SocketCAN.",
    )(function)


def json_option(function: F) -> F:
    """--json: the same figures for a program to read."""
    return click.option("--json", "as_json", is_flag=True, help="Print JSON instead of a table.")(
        function
    )


def refuse(options: Mapping[str, Any], names: Iterable[str], why: str) -> None:
    """Refuse options that were given and would change nothing: silence would mislead.

    Raises:
        ConfigError: one of ``names`` was given; it is named.
    """
    for name in names:
        value = options[name]
        if not (value is None or value is False or value == ()):  # 0 was said, too
            raise ConfigError(f"--{name.replace('_', '-')}: has no effect here; {why}")


def check_folder(path: Path | None) -> None:
    """Refuse a file that could not be written once all the work is done.

    Raises:
        ConfigError: there is no folder for it; the file is named.
    """
    if path is not None and not path.absolute().parent.is_dir():
        raise ConfigError(f"{path}: there is no such folder to write into")
