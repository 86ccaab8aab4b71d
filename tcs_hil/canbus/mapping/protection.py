"""How a message is protected, seen from either end; the ways of it are in the files beside."""

from __future__ import annotations

from typing import Protocol

from tcs_hil.canbus.e2e import E2EStatus


class Check(Protocol):
    """Receiver's side of one message."""

    def check(self, payload: bytes) -> E2EStatus:
        """Judge the next frame of the message; its values count only when ``OK``."""
        ...


class Protect(Protocol):
    """Sender's side of one message."""

    def protect(self, payload: bytearray) -> None:
        """Write the next counter and the checksum into ``payload``, whose own are zero."""
        ...


class Protection(Protocol):
    """What both ends of a message have agreed on."""

    def checker(self) -> Check:
        """Make a receiver's side, which has seen no frame yet."""
        ...

    def protector(self) -> Protect:
        """Make a sender's side, which has sent none."""
        ...
