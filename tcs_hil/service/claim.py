"""One service to a channel: a second one would send what only the first may send."""

from __future__ import annotations

import errno
import hashlib
import os
import socket
import struct
from typing import Self

from tcs_hil.errors import BusError

_CREDENTIALS = struct.Struct("=iII")
"""``struct ucred``: process, user and group of a socket's other end."""
_CALLERS = 128
"""Rivals that may ask who we are; nobody answers them, so after that many the next is not told."""


class ChannelClaim:
    """Context in which no other service can claim the same channel of the same interface.

    The claim is a name in the abstract namespace of AF_UNIX: the kernel gives it
    back however the process ends, so none can be stale, and network namespaces
    keep theirs apart as they do their CAN interfaces.  Source: unix(7).
    """

    def __init__(self, interface: str, channel: str) -> None:
        """Claim ``channel``; ``interface`` is what python-can calls it, never ``auto``.

        Raises:
            BusError: Another service holds it; its process is named.
        """
        name = _name(interface, channel)
        self._holder = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        try:
            self._holder.bind(name)
        except OSError as error:
            self._holder.close()
            if error.errno != errno.EADDRINUSE:
                raise
            raise BusError(
                f"{interface} {channel} already has a traction control service{_holder_of(name)}"
            ) from error
        self._holder.listen(_CALLERS)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._holder.close()


def _name(interface: str, channel: str) -> bytes:
    # An embedded channel belongs to a user, every other one to the machine.
    whose = str(os.getuid()) if interface == "embedded" else "everybody's"
    # Hashed, as a channel may have a longer name than a socket.
    what = "\0".join((interface, whose, channel)).encode()
    return b"\0tcs-hil/" + hashlib.sha256(what).hexdigest().encode()


def _holder_of(name: bytes) -> str:
    """The process that holds a name, as an insertion; empty if it cannot be told."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM | socket.SOCK_NONBLOCK) as caller:
        try:
            caller.connect(name)
            answer = caller.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, _CREDENTIALS.size)
        except OSError:
            return ""
    process = _CREDENTIALS.unpack(answer)[0]
    return f" (process {process})" if process else ""
