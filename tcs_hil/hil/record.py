"""Recording a bus, in a process of its own so that the tick never waits for a disk."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import can

from tcs_hil.errors import ConfigError

POLL_S = 0.1


def record(
    bus: can.BusABC, path: Path, stop: Callable[[], bool], ready: Callable[[], object]
) -> int:
    """Write every frame of ``bus`` to ``path`` until ``stop()``; returns how many.

    The suffix chooses the format, as in python-can: ``.blf``, ``.asc``, ``.log``
    (candump) and others.

    Raises:
        ConfigError: python-can knows no such suffix, or the file cannot be made.
    """
    with _writer(path) as write:
        ready()
        count = 0
        while not stop():
            message = bus.recv(POLL_S)
            if message is not None:
                write(message)
                count += 1
        while (message := bus.recv(0.0)) is not None:
            write(message)
            count += 1
    return count


def _writer(path: Path) -> can.io.generic.MessageWriter:
    try:
        return can.Logger(str(path))
    except OSError as error:
        raise ConfigError(f"{path}: cannot be written ({error.strerror})") from error
    except ValueError as error:
        raise ConfigError(f"{path}: no CAN recording format has this suffix") from error
