"""Bus logs in every format python-can reads."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import can

from tcs_hil.errors import ConfigError

NS_PER_S = 1_000_000_000


def read_log(path: Path) -> Iterator[can.Message]:
    """Every data frame of a log in its order, stamped in seconds since 1970 where the log is.

    By suffix: ``.blf``, ``.asc``, candump's ``.log`` and others; ``.mf4`` where
    asammdf is installed.

    Raises:
        ConfigError: the file cannot be read; it is named.
    """
    # python-can would let an ASC log begin at zero, though its header has a date.
    options = {"relative_timestamp": False} if path.suffix.lower() == ".asc" else {}
    try:
        with can.LogReader(str(path), **options) as reader:
            for message in reader:
                if not (message.is_error_frame or message.is_remote_frame):
                    yield message
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read ({error.strerror or error})") from error
    except Exception as error:  # python-can's readers raise whatever the damage leads to
        raise ConfigError(f"{path}: no recording python-can can read here ({error})") from error


def stamp_ns(message: can.Message) -> int:
    """The stamp as whole nanoseconds; a log of today holds a quarter of a microsecond."""
    return round(message.timestamp * NS_PER_S)
