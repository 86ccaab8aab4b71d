"""Which bus to use: the one place that turns python-can's errors into ours."""

from __future__ import annotations

import contextlib
import socket
from typing import Any

import can
from can.interfaces.socketcan import SocketcanBus

from tcs_hil.canbus.embedded import EmbeddedBus
from tcs_hil.errors import BusError

RECEIVE_BUFFER_BYTES = 4 << 20
"""The kernel's default holds some 280 frames: a fifth of a second of this bus."""
RATELESS = {
    "socketcan": "`ip link` sets that of a SocketCAN interface",
    "embedded": "the embedded bus has no wire",
}
"""Why an interface does not take a bit rate; python-can would pass it over in silence."""
_SO_RCVBUFFORCE = 33  # asm-generic/socket.h; not in the socket module


def open_bus(
    interface: str = "auto", channel: str = "vcan0", bitrate: int | None = None
) -> tuple[can.BusABC, str]:
    """Open a CAN bus; the options mean what they mean in python-can.

    ``auto`` takes SocketCAN where the kernel has an interface called ``channel``
    and the embedded bus where it has none and the name begins with ``vcan``.

    Returns:
        The bus and a line that says which one it is.

    Raises:
        BusError: The interface is unknown, missing or cannot be opened, or does not
            take a ``bitrate``.
    """
    chosen, description = choose_interface(interface, channel)
    if bitrate is not None and chosen in RATELESS:
        why = RATELESS[chosen]
        raise BusError(f"bitrate {bitrate}: has no effect on {chosen} {channel}; {why}")
    return _open(chosen, channel, bitrate), description


def choose_interface(interface: str, channel: str) -> tuple[str, str]:
    """Settle which python-can interface ``open_bus`` takes, and the line that says so.

    Raises:
        BusError: The kernel has no such CAN interface and nothing may replace it.
    """
    if interface not in ("auto", "socketcan"):
        return interface, f"{interface} {channel}"
    if _is_can_interface(channel):
        return "socketcan", f"socketcan {channel}"
    if interface == "auto" and channel.startswith("vcan"):
        return "embedded", f"embedded {channel} (this kernel has no SocketCAN {channel})"
    raise BusError(f"there is no CAN interface {channel} in this kernel; {_remedy(channel)}")


def _is_can_interface(name: str) -> bool:
    try:
        with socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW) as probe:
            probe.bind((name,))
    except OSError:
        return False
    return True


def _open(interface: str, channel: str, bitrate: int | None) -> can.BusABC:
    options: dict[str, Any] = {} if bitrate is None else {"bitrate": bitrate}
    try:
        if interface == "embedded":
            return EmbeddedBus(channel)
        bus = can.Bus(channel=channel, interface=interface, **options)
    except (can.CanError, NotImplementedError, OSError, ValueError, TypeError) as error:
        raise BusError(f"cannot open {interface} {channel}: {error}") from error
    if isinstance(bus, SocketcanBus):
        _enlarge_receive_buffer(bus.socket)
    return bus


def _enlarge_receive_buffer(sock: socket.socket) -> None:
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, RECEIVE_BUFFER_BYTES)
    # Past net.core.rmem_max only with CAP_NET_ADMIN; without it the maximum has to do.
    with contextlib.suppress(PermissionError):
        sock.setsockopt(socket.SOL_SOCKET, _SO_RCVBUFFORCE, RECEIVE_BUFFER_BYTES)


def _remedy(channel: str) -> str:
    if channel.startswith("vcan"):
        return f"make it with 'ip link add dev {channel} type vcan && ip link set {channel} up'"
    return f"bring it up with 'ip link set {channel} up type can bitrate 500000'"
