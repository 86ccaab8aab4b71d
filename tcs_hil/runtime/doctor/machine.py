"""What the checks read of the machine, so that they can be shown any other."""

from __future__ import annotations

import resource
import socket
import subprocess
import time
from importlib import metadata
from pathlib import Path
from typing import Protocol

from tcs_hil import native

PATIENCE_S = 30.0


class Machine(Protocol):
    """Everything a check may ask; nothing here raises."""

    def read(self, path: str) -> str | None:
        """Text of a file without the white space around it, None if it cannot be read."""
        ...

    def glob(self, pattern: str) -> list[str]:
        """Paths of the files that match an absolute pattern, sorted."""
        ...

    def run(self, *command: str) -> str | None:
        """What a program prints, None if it is not installed or fails."""
        ...

    def limit(self, which: int) -> float:
        """A soft resource limit (``resource.RLIMIT_*``), infinite if there is none."""
        ...

    def version(self, distribution: str) -> str | None:
        """Version of an installed Python distribution."""
        ...

    def has_native_step(self) -> bool:
        """Whether the package was installed with its compiled extension."""
        ...

    def has_compiled_tick(self) -> bool:
        """Whether the rest of a tick was compiled too."""
        ...

    def speaks_can(self) -> bool:
        """Whether the kernel has CAN sockets."""
        ...

    def timer_resolution_s(self) -> float:
        """Resolution of CLOCK_MONOTONIC."""
        ...


class ThisMachine:
    """The machine this process runs on."""

    def read(self, path: str) -> str | None:
        """Read a file, most likely of /proc or /sys."""
        try:
            return Path(path).read_text(encoding="utf-8", errors="replace").strip()
        except OSError:
            return None

    def glob(self, pattern: str) -> list[str]:
        """Find files."""
        return sorted(str(path) for path in Path("/").glob(pattern.lstrip("/")))

    def run(self, *command: str) -> str | None:
        """Run a program to its end."""
        try:
            ended = subprocess.run(
                command, capture_output=True, text=True, check=True, timeout=PATIENCE_S
            )
        except (OSError, subprocess.SubprocessError):
            return None
        return ended.stdout

    def limit(self, which: int) -> float:
        """Ask for a limit of this process, which its children inherit."""
        soft, _ = resource.getrlimit(which)
        return float("inf") if soft == resource.RLIM_INFINITY else soft

    def version(self, distribution: str) -> str | None:
        """Look among the installed distributions."""
        try:
            return metadata.version(distribution)
        except metadata.PackageNotFoundError:
            return None

    def has_native_step(self) -> bool:
        """Ask the package."""
        return native.is_built()

    def has_compiled_tick(self) -> bool:
        """Ask the package."""
        return native.tick_is_compiled()

    def speaks_can(self) -> bool:
        """Try to make a CAN socket."""
        try:
            socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW).close()
        except OSError:
            return False
        return True

    def timer_resolution_s(self) -> float:
        """Ask the clock."""
        return time.clock_getres(time.CLOCK_MONOTONIC)
