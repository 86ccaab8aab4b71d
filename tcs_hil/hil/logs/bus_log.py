"""Bus logs in every format python-can reads, whole or as far as they go."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

import can
from can.io.generic import MessageReader

from tcs_hil.errors import ConfigError

NS_PER_S = 1_000_000_000


class BrokenOffError(ConfigError):
    """A log cannot be read to its end; the frames before have been given."""


class Salvage(NamedTuple):
    """The frames of a log as far as it can be read, and what was lost; empty for nothing."""

    frames: list[can.Message]
    lost: str = ""


def read_log(path: Path) -> Iterator[can.Message]:
    """Every data frame of a log in its order, stamped in seconds since 1970 where the log is.

    By suffix: ``.blf``, ``.asc``, candump's ``.log`` and others; ``.mf4`` where
    asammdf is installed.

    Raises:
        BrokenOffError: the log is damaged behind the frames given so far, or cut short.
        ConfigError: the file cannot be read; it is named.
    """
    count = 0
    try:
        with ExitStack() as files:
            reader = _opened(path, files)
            for message in reader:
                count += 1
                if not (message.is_error_frame or message.is_remote_frame):
                    yield message
            missing = _missing(reader, path, count)
    except Exception as error:  # python-can's readers raise whatever the damage leads to
        if count:
            raise BrokenOffError(f"{path}: breaks off after {count} frames ({error})") from error
        if isinstance(error, OSError):
            raise ConfigError(f"{path}: cannot be read ({error.strerror or error})") from error
        raise ConfigError(f"{path}: no recording python-can can read here ({error})") from error
    if missing:
        raise BrokenOffError(f"{path}: {missing}")


def salvage_log(path: Path) -> Salvage:
    """What `read_log` can read, and a sentence on what it cannot.

    Raises:
        ConfigError: there is not a single frame to be had; the file is named.
    """
    frames: list[can.Message] = []
    try:
        for message in read_log(path):
            frames.append(message)  # noqa: PERF402 - they must be kept when the next one raises
    except BrokenOffError as error:
        if not frames:
            raise
        return Salvage(frames, str(error))
    return Salvage(frames)


def stamp_ns(message: can.Message) -> int:
    """The stamp as whole nanoseconds; a log of today holds a quarter of a microsecond."""
    return round(message.timestamp * NS_PER_S)


def _opened(path: Path, files: ExitStack) -> MessageReader:
    if path.suffix.lower() == ".blf":
        # Opened here, because python-can does not close a file that is no BLF after all.
        return can.BLFReader(files.enter_context(path.open("rb")))
    return files.enter_context(can.LogReader(str(path), **_options(path)))


def _options(path: Path) -> dict[str, Any]:
    """python-can would let an ASC log begin at zero, though its header has a date."""
    return {"relative_timestamp": False} if path.suffix.lower() == ".asc" else {}


def _missing(reader: object, path: Path, count: int) -> str:
    """What a BLF file's header promises and the file does not hold: python-can says nothing."""
    if not isinstance(reader, can.BLFReader):
        return ""
    if path.stat().st_size < reader.file_size:
        counted = reader.object_count
        return f"is cut short: {count} frames were read of the {counted} records it once had"
    if count and not reader.object_count:
        return f"was never closed: {count} frames were read, what was to follow is lost"
    return ""
