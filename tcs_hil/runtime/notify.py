"""Readiness and watchdog messages to systemd: the sd_notify protocol."""

from __future__ import annotations

import os
import socket


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
