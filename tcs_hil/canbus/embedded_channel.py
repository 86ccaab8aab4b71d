"""Meeting place of an embedded bus: a private directory with one socket per node.

A lock makes arriving atomic: a node binds its own socket and connects to every
other before the next may do so, so any two nodes share exactly one connection.
The kernel completes a connection before it is accepted, hence nobody has to be
awake for a newcomer, and a dead node's socket refuses and is swept away.
"""

from __future__ import annotations

import fcntl
import os
import secrets
import socket
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import can

_BACKLOG = 128
_LOCK_NAME = "lock"
_SUFFIX = ".node"


class Channel:
    """This node's presence on a channel: ``listener`` and the ``peers`` met on arrival."""

    def __init__(self, name: str) -> None:
        """Arrive on channel ``name``.

        Raises:
            can.CanInitializationError: The name or the directory cannot be used.
        """
        if not name or "/" in name or name.startswith("."):
            raise can.CanInitializationError(f"{name!r} cannot be the name of an embedded channel")
        self.listener = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET | socket.SOCK_NONBLOCK)
        self.peers: list[socket.socket] = []
        try:
            directory = _private_directory(_base()) / name
            self._path = directory / f"{os.getpid()}-{secrets.token_hex(4)}{_SUFFIX}"
            self._arrive(_private_directory(directory))
        except OSError as error:
            for link in (self.listener, *self.peers):
                link.close()
            raise can.CanInitializationError(f"embedded channel {name}: {error}") from error

    def leave(self) -> None:
        """Take no more visitors; connections stay with whoever holds them."""
        self._path.unlink(missing_ok=True)
        self.listener.close()

    def _arrive(self, directory: Path) -> None:
        with _locked(directory / _LOCK_NAME):
            for path in directory.glob(f"*{_SUFFIX}"):
                self._meet(path)
            self.listener.bind(str(self._path))
            self.listener.listen(_BACKLOG)

    def _meet(self, path: Path) -> None:
        """Connect to a node, or sweep away what a dead one left behind."""
        peer = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET | socket.SOCK_NONBLOCK)
        self.peers.append(peer)
        try:
            peer.connect(str(path))
        except (ConnectionRefusedError, FileNotFoundError):
            path.unlink(missing_ok=True)
            self.peers.pop().close()


def _base() -> Path:
    runtime = os.environ.get("XDG_RUNTIME_DIR")
    if runtime and Path(runtime).is_dir():
        return Path(runtime) / "tcs-hil"
    return Path(tempfile.gettempdir()) / f"tcs-hil-{os.getuid()}"


def _private_directory(path: Path) -> Path:
    path.mkdir(mode=0o700, exist_ok=True)
    status = path.lstat()
    if not stat.S_ISDIR(status.st_mode) or status.st_uid != os.getuid() or status.st_mode & 0o077:
        raise PermissionError(f"{path} must be a directory that only this user can enter")
    return path


@contextmanager
def _locked(path: Path) -> Iterator[None]:
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)
