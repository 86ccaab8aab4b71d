"""System calls that Python's standard library has no name for."""

from __future__ import annotations

import ctypes
import os
from pathlib import Path

CLONE_NEWUSER = 0x1000_0000
CLONE_NEWNET = 0x4000_0000

_MS_MOVE = 0x2000
_POWER_OFF = 0x4321_FEDC
_FINIT_MODULE = 313  # x86-64, the only machine User-Mode Linux is built for here

_libc = ctypes.CDLL(None, use_errno=True)


def _check(result: int, what: str) -> None:
    if result != 0:
        code = ctypes.get_errno()
        raise OSError(code, f"{what}: {os.strerror(code)}")


def mount(source: str, target: str, kind: str, options: str = "") -> None:
    """Mount a file system; raises OSError that names both ends."""
    arguments = (source.encode(), target.encode(), kind.encode(), 0, options.encode())
    _check(_libc.mount(*arguments), f"mount {kind} {source} on {target}")


def make_root(folder: Path) -> None:
    """Put the file system mounted on the folder in the place of `/`; raises OSError.

    A mere chroot would forbid what runs inside to make user namespaces.
    """
    os.chdir(folder)
    _check(_libc.mount(b".", b"/", None, _MS_MOVE, None), f"move {folder} to /")
    os.chroot(".")
    os.chdir("/")


def unshare(flags: int) -> None:
    """Leave the namespaces named by the `CLONE_NEW*` flags for new ones; raises OSError."""
    _check(_libc.unshare(flags), "unshare")


def load_module(path: Path) -> None:
    """Load a kernel module file whose dependencies are loaded; raises OSError."""
    with path.open("rb") as module:
        _check(_libc.syscall(_FINIT_MODULE, module.fileno(), b"", 0), f"load {path.name}")


def power_off() -> None:
    """End this machine; only PID 1 of a guest wants this."""
    _libc.sync()
    _libc.reboot(_POWER_OFF)
