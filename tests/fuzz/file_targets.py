"""Whatever is read from a file: only a TcsError may come of it."""

from __future__ import annotations

import atexit
import contextlib
import itertools
import os
import shutil
import struct
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

from plant_emulator.road_file import read_road
from plant_emulator.scenario import Scenario
from plant_emulator.tir import read_tir
from tcs_hil.canbus.database import DBC_ENCODING, load_database
from tcs_hil.config import read_toml
from tcs_hil.errors import TcsError
from tcs_hil.hil.logs.bus_log import read_log
from tcs_hil.model import archive
from tcs_hil.model.bank import KoopmanBank, default_bank_path
from tcs_hil.model.predictor import KoopmanPredictor, default_model_path
from tcs_hil.runtime import recording
from tcs_hil.service.settings import ServiceConfig

PERIOD_S = 0.002
GOOD_DBC = Path("dbc/tcs.dbc").read_text(encoding=DBC_ENCODING)
LOG_SUFFIXES = (".asc", ".log", ".blf", ".csv", ".trc")
LONGEST_LOG = 1000
EDIT = struct.Struct("<HBB")  # where, how much goes, how much comes

_MEMORY = "/dev/shm"  # noqa: S108 - a file a millisecond is too much for a disk
_SCRATCH = Path(tempfile.mkdtemp(prefix="fuzz-", dir=_MEMORY if Path(_MEMORY).is_dir() else None))
atexit.register(shutil.rmtree, _SCRATCH)


def through_file(content: bytes, read: Callable[[Path], object], suffix: str = "") -> None:
    """Let ``read`` read a file that holds ``content``; our own errors are good answers."""
    path = _SCRATCH / f"{os.getpid()}{suffix}"
    path.write_bytes(content)
    with contextlib.suppress(TcsError):
        read(path)


def dbc(data: bytes) -> None:
    """The DBC of the project after a few edits; a whole file at once would never parse."""
    text, rest = GOOD_DBC, data
    while len(rest) > EDIT.size:
        where, gone, come = EDIT.unpack_from(rest)
        at = where % len(text)
        inserted = rest[EDIT.size : EDIT.size + come].decode("latin-1")
        text = text[:at] + inserted + text[at + gone :]
        rest = rest[EDIT.size + come :]
    through_file(text.encode(DBC_ENCODING, "replace"), load_database)


def config(data: bytes) -> None:
    """The service's configuration."""
    through_file(data, lambda path: read_toml(path, ServiceConfig))


def scenario(data: bytes) -> None:
    """A scenario, without the files it may name."""
    through_file(data, lambda path: read_toml(path, Scenario))


def road(data: bytes) -> None:
    """A road from a CSV file."""
    through_file(data, read_road)


def tyre(data: bytes) -> None:
    """A tyre property file."""
    through_file(data, read_tir)


def model(data: bytes) -> None:
    """A model file as it lies there, or with metadata or numbers of ours and a good digest."""
    for load, good in (
        (KoopmanBank.load, default_bank_path()),
        (KoopmanPredictor.load, default_model_path()),
    ):
        path = _SCRATCH / f"{os.getpid()}.npz"
        with contextlib.suppress(TcsError):
            _forge(path, good, data)
            load(path, PERIOD_S)


def _forge(path: Path, good: Path, data: bytes) -> None:
    how, content = data[:1], data[1:]
    metadata, arrays = archive.read(good)
    if how == b"m":
        archive.write(path, content, arrays)
    elif how == b"a":
        numbers = np.frombuffer(content[: len(content) // 8 * 8], dtype="<f8")
        names = sorted(arrays)
        name = names[len(content) % len(names)]
        whole = np.resize(numbers, arrays[name].shape) if numbers.size else numbers
        archive.write(path, metadata, {**arrays, name: whole})
    else:
        path.write_bytes(data)


def flight_recording(data: bytes) -> None:
    """A flight recording."""
    through_file(data, recording.read)
    through_file(data, recording.read_info)


def bus_log(data: bytes) -> None:
    """A log of the bus in any format."""
    suffix = LOG_SUFFIXES[data[0] % len(LOG_SUFFIXES)] if data else LOG_SUFFIXES[0]
    through_file(data[1:], lambda path: list(itertools.islice(read_log(path), LONGEST_LOG)), suffix)
