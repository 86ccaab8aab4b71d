"""Which files a run left: from a run's folder, or from the files themselves."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from pathlib import Path

from tcs_hil.errors import ConfigError
from tcs_hil.hil.run import RunFiles
from tcs_hil.runtime.recording import MAGIC


@dataclass(frozen=True, slots=True)
class Sources:
    """The parts of one run that are at hand; None for those that are not."""

    bus: Path | None = None
    flight: Path | None = None
    truth: Path | None = None
    config: Path | None = None


def find_sources(paths: Iterable[Path]) -> Sources:
    """Sort ``paths``, each a run's folder or one file, into the parts of one run.

    A flight recording is known by its first bytes, the plant's truth by ``.npz``;
    every other file is taken for a bus log.

    Raises:
        ConfigError: a path leads nowhere, a folder holds no run, or two paths are
            the same part.
    """
    found = Sources()
    for path in paths:
        found = _merged(found, _of_folder(path) if path.is_dir() else _of_file(path))
    return found


def _of_folder(folder: Path) -> Sources:
    files = RunFiles(folder)
    kept = {
        field.name: path
        for field in fields(Sources)
        if (path := getattr(files, field.name)).is_file()
    }
    if not kept.keys() - {"config"}:
        raise ConfigError(f"{folder}: holds no run ({files.bus.name}, {files.flight.name})")
    return Sources(**kept)


def _of_file(path: Path) -> Sources:
    try:
        with path.open("rb") as file:
            start = file.read(len(MAGIC))
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read ({error.strerror})") from error
    if start == MAGIC:
        return Sources(flight=path)
    return Sources(truth=path) if path.suffix == ".npz" else Sources(bus=path)


def _merged(found: Sources, more: Sources) -> Sources:
    for field in fields(Sources):
        old, new = getattr(found, field.name), getattr(more, field.name)
        if old is not None and new is not None:
            raise ConfigError(f"{old} and {new} are both the {field.name} of a run; give one run")
        found = replace(found, **{field.name: old or new})
    return found
