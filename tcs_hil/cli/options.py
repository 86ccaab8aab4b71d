"""Options that mean the same in every command."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

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
