"""Flight-recorder files: the layout on disk, and the reader."""

from __future__ import annotations

import mmap
import struct
from pathlib import Path
from typing import Annotated, Literal, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from tcs_hil.errors import TcsError

MAGIC = b"TCSFLREC"
LAYOUT_VERSION = 1
PREAMBLE = struct.Struct("<8sIIQQ")
"""Magic, layout version, size of the JSON header, offset of the ring, capacity in records."""
COUNT_OFFSET = PREAMBLE.size  # u64: records written since the start, raised after each of them
COUNT_MAX = 1 << 48  # seventeen thousand years of ticks
HEADER_OFFSET = COUNT_OFFSET + 8


class RecordingError(TcsError):
    """A flight-recorder file cannot be made or read."""


FieldCode = Literal["<i8", "<f8", "|u1", "|b1"]


class RunInfo(msgspec.Struct, frozen=True, kw_only=True):
    """Which run a recording belongs to; the two start times tie its clock to the calendar."""

    period_ns: int
    started_monotonic_ns: int
    started_realtime_ns: int
    controller: str
    backend: str = "unknown"  # recordings from before there were two do not say
    bus: str
    machine: str


class Header(msgspec.Struct, frozen=True):
    """The JSON header: the run, and the fields as numpy describes them.

    A reader takes the fields from here, so a recording outlives changes to them.
    """

    run: RunInfo
    fields: Annotated[list[tuple[str, FieldCode]], msgspec.Meta(min_length=1)]


class Bookmark(NamedTuple):
    """How far a reader has come: the run, and how many of its ticks were made by then."""

    run: RunInfo
    made: int


def read(path: Path) -> NDArray[np.void]:
    """Return the ticks of a recording as a structured array (n,), oldest first.

    The run may still be going on, or have been killed: ticks whose record may
    be half written are left out.

    Raises:
        RecordingError: the file cannot be opened, or is not a whole recording.
    """
    return read_on(path, None)[0]


def read_on(path: Path, bookmark: Bookmark | None) -> tuple[NDArray[np.void], Bookmark]:
    """Return the ticks since ``bookmark`` like ``read``, and the next bookmark.

    Ticks the ring has dropped since are missing; another run is read from its start.

    Raises:
        RecordingError: the file cannot be opened, or is not a whole recording.
    """
    with _mapped(path) as view:
        header, start, capacity = _layout(path, view)
        dtype = np.dtype(header.fields)
        if len(view) < start + capacity * dtype.itemsize:
            raise RecordingError(f"{path}: the recording is cut short")
        ring = np.frombuffer(view, dtype, capacity, start)
        end = _count(view)
        seen = bookmark.made if bookmark is not None and bookmark.run == header.run else 0
        first = max(end - capacity, seen)
        ticks = ring[np.arange(first, end) % capacity]
        # The writer may have moved on meanwhile, and be at work on one more record.
        overwritten = _count(view) + 1 - capacity - first
        del ring  # the map cannot be closed while an array looks into it
        return ticks[max(overwritten, 0) :], Bookmark(header.run, end)


def read_info(path: Path) -> RunInfo:
    """Return what the header says about the run.

    Raises:
        RecordingError: the file cannot be opened, or is not a recording.
    """
    with _mapped(path) as view:
        return _layout(path, view)[0].run


def _mapped(path: Path) -> mmap.mmap:
    try:
        with path.open("rb") as file:
            return mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ)
    except OSError as error:
        raise RecordingError(f"{path}: cannot be read ({error.strerror})") from error
    except ValueError as error:  # an empty file cannot be mapped
        raise RecordingError(f"{path}: not a flight recording") from error


def _layout(path: Path, view: mmap.mmap) -> tuple[Header, int, int]:
    if len(view) < HEADER_OFFSET or view[: len(MAGIC)] != MAGIC:
        raise RecordingError(f"{path}: not a flight recording")
    _, version, header_size, start, capacity = PREAMBLE.unpack_from(view)
    if version != LAYOUT_VERSION:
        raise RecordingError(f"{path}: layout version {version} is not {LAYOUT_VERSION}")
    text = view[HEADER_OFFSET : HEADER_OFFSET + header_size]
    try:
        header = msgspec.json.decode(text, type=Header)
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise RecordingError(f"{path}: the header is damaged: {error}") from error
    if capacity < 1 or _count(view) > COUNT_MAX:
        raise RecordingError(f"{path}: the header is damaged")
    return header, start, capacity


def _count(view: mmap.mmap) -> int:
    (count,) = struct.unpack_from("<Q", view, COUNT_OFFSET)
    return int(count)
