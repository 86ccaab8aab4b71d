"""Readiness and watchdog messages to systemd: the sd_notify protocol."""

from __future__ import annotations

import os
import socket
from collections.abc import Callable


def notify(state: str) -> bool:
    """Send ``state`` (``READY=1``, ``WATCHDOG=1``, ``STATUS=...``) to the service manager.

    Returns whether it was sent: False without a manager or when it does not
    listen, because a daemon must not fail for want of an audience.  Source:
    sd_notify(3).
    """
    address = os.environ.get("NOTIFY_SOCKET", "")
    if not address:
        return False
    if address.startswith("@"):  # how systemd spells Linux's abstract namespace
        address = "\0" + address[1:]
    try:
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC) as channel:
            channel.connect(address)
            channel.send(state.encode(), socket.MSG_DONTWAIT)
    except OSError:
        return False
    return True


class Watchdog:
    """Tells the service manager that ticks are healthy, twice per watchdog interval.

    Nobody feeds it out of turn: a loop that hangs or keeps failing falls silent
    and is restarted.  Does nothing where ``WATCHDOG_USEC`` asks for nothing.
    """

    def __init__(self, send: Callable[[str], bool] = notify) -> None:
        self._send = send
        self._every_ns = int(os.environ.get("WATCHDOG_USEC", "0")) * 1000 // 2
        self._due_ns = 0

    def feed(self, now_ns: int) -> None:
        """Report a healthy tick at ``now_ns`` on the monotonic clock."""
        if self._every_ns and now_ns >= self._due_ns:
            self._due_ns = now_ns + self._every_ns
            self._send("WATCHDOG=1")
