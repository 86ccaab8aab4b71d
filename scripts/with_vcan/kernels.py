"""Finds a User-Mode-Linux kernel on this machine."""

from __future__ import annotations

import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Kernel:
    """A bootable kernel.

    Attributes:
        path: the executable.
        release: what `uname -r` says inside.
        simulated_time: whether its clock can be simulated.
        modules: folder of its loadable modules; None where all is built in.
    """

    path: Path
    release: str
    simulated_time: bool
    modules: Path | None


def find(wanted: str | None) -> Kernel | None:
    """The wanted kernel, else the one `build-vcan-kernel` made, else the distribution's."""
    candidates = [wanted] if wanted else [str(_built()), "linux.uml"]
    for candidate in candidates:
        if path := shutil.which(candidate):
            return _describe(Path(path).resolve())
    return None


def _built() -> Path:
    cache = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(cache) / "tcs-hil" / "vcan-kernel" / "linux"


def _describe(path: Path) -> Kernel:
    release = _ask(path, "--version").strip()
    modules = path.parent.parent / "lib" / "uml" / "modules" / release
    return Kernel(
        path=path,
        release=release,
        simulated_time="CONFIG_UML_TIME_TRAVEL_SUPPORT=y" in _ask(path, "--showconfig"),
        modules=modules if modules.is_dir() else None,
    )


def _ask(path: Path, question: str) -> str:
    return subprocess.run([path, question], capture_output=True, text=True, check=False).stdout
