"""Flight recorder: every tick into a ring on disk that outlives the process.

The ring is a shared mapping, so the kernel owns what has been written the
moment it is written: ``kill -9`` loses at most the record in the making.
"""

from __future__ import annotations

import mmap
import os
from pathlib import Path
from typing import Self

import msgspec

from tcs_hil.runtime.record import LAYOUT, PACKER, Record
from tcs_hil.runtime.recording import (
    COUNT_OFFSET,
    HEADER_OFFSET,
    LAYOUT_VERSION,
    MAGIC,
    PREAMBLE,
    Header,
    RecordingError,
    RunInfo,
)


class FlightRecorder:
    """Writer of one recording of a fixed size; the newest ``capacity`` ticks are kept.

    An existing recording is kept as ``*.previous``: the service that is restarted
    after a crash must not erase what led to it.  Any other file is left alone.

    Raises:
        RecordingError: the file cannot be made, is not ours to replace, or the disk
            has no room for it.
    """

    def __init__(self, path: Path, run: RunInfo, capacity: int) -> None:
        header = msgspec.json.encode(Header(run, LAYOUT))
        self._start = -(-(HEADER_OFFSET + len(header)) // mmap.PAGESIZE) * mmap.PAGESIZE
        self._capacity = capacity
        self._written = 0
        self._map = _create(path, self._start + capacity * PACKER.size)
        self._map[HEADER_OFFSET : HEADER_OFFSET + len(header)] = header
        PREAMBLE.pack_into(self._map, 0, MAGIC, LAYOUT_VERSION, len(header), self._start, capacity)
        # A cast view stores the count as one 64-bit word, which a reader never sees half.
        self._count = memoryview(self._map)[COUNT_OFFSET : COUNT_OFFSET + 8].cast("Q")

    def write(self, record: Record) -> None:
        """Add one tick, over the oldest when the ring is full."""
        offset = self._start + self._written % self._capacity * PACKER.size
        PACKER.pack_into(self._map, offset, *record)
        self._written += 1
        self._count[0] = self._written

    def close(self) -> None:
        """Let go of the file; nothing needs to be flushed."""
        self._count.release()
        self._map.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _create(path: Path, size: int) -> mmap.mmap:
    """Reserve ``size`` bytes now: a disk that fills up later would end the tick with SIGBUS."""
    try:
        _put_aside(path)
        with path.open("x+b") as file:
            return _reserved(path, file.fileno(), size)
    except OSError as error:
        raise RecordingError(
            f"{path}: no flight recording of {size / 1e6:.0f} MB ({error.strerror})"
        ) from error


def _put_aside(path: Path) -> None:
    """Keep an earlier recording; a file of any other kind was named by mistake."""
    if not path.exists():
        return
    if not path.is_file() or not _begins_with_magic(path):
        raise RecordingError(f"{path}: exists and is not a flight recording")
    path.replace(path.with_name(f"{path.name}.previous"))


def _begins_with_magic(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(len(MAGIC)) == MAGIC


def _reserved(path: Path, descriptor: int, size: int) -> mmap.mmap:
    try:
        os.posix_fallocate(descriptor, 0, size)
    except OSError:
        path.unlink()
        raise
    # Populated, so that the first lap reads nothing from disk; a file system that keeps track of
    # what is written still takes a short fault for a page's first write.
    return mmap.mmap(descriptor, size, mmap.MAP_SHARED | mmap.MAP_POPULATE)
