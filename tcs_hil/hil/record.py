"""Recording a bus, in a process of its own so that the tick never waits for a disk."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from pathlib import Path

import can

from tcs_hil.canbus.embedded import EmbeddedBus
from tcs_hil.errors import ConfigError

POLL_S = 0.1
FIRST_CHANNEL = 0  # of a recording; python-can would take digits out of the interface's name


def record(
    bus: can.BusABC, path: Path, stop: Callable[[], bool], ready: Callable[[], object]
) -> int:
    """Write every frame of ``bus`` to ``path`` until ``stop()``; returns how many.

    The suffix chooses the format, as in python-can: ``.blf``, ``.asc``, ``.log``
    (candump) and others.

    Raises:
        ConfigError: python-can knows no such suffix, or the file cannot be made.
    """
    offset_s = _calendar_offset_s(bus)
    stopped_s = math.inf
    count = 0
    with _writer(path) as write:
        ready()
        while True:
            message = bus.recv(POLL_S if stopped_s == math.inf else 0.0)
            if stopped_s == math.inf and stop():
                stopped_s = time.time()
            # What was on its way at the stop is still drained; a busy bus must not keep us.
            if stopped_s < math.inf and (
                message is None or message.timestamp + offset_s > stopped_s
            ):
                return count
            if message is not None:
                write(_as_recorded(message, path, offset_s))
                count += 1


def _as_recorded(message: can.Message, path: Path, offset_s: float) -> can.Message:
    message.timestamp += offset_s
    if path.suffix == ".blf":
        message.channel = FIRST_CHANNEL
    return message


def _calendar_offset_s(bus: can.BusABC) -> float:
    """What turns the bus's stamps into times since 1970, as recordings carry them."""
    return time.time() - time.monotonic() if isinstance(bus, EmbeddedBus) else 0.0


def _writer(path: Path) -> can.io.generic.MessageWriter:
    if not path.absolute().parent.is_dir():
        raise ConfigError(f"{path}: there is no such folder to write the recording into")
    try:
        return can.Logger(str(path))
    except OSError as error:
        raise ConfigError(f"{path}: cannot be written ({error.strerror})") from error
    except (ValueError, NotImplementedError) as error:
        raise ConfigError(f"{path}: no recording format at hand has this suffix") from error
