"""Makes virtual CAN interfaces and brings interfaces up, without iproute2."""

from __future__ import annotations

import fcntl
import os
import socket
import struct
import sys

# linux/rtnetlink.h, linux/if_link.h, linux/netlink.h
_RTM_NEWLINK = 16
_REQUEST_ACK_CREATE_EXCLUSIVE = 0x1 | 0x4 | 0x400 | 0x200
_IFLA_IFNAME, _IFLA_LINKINFO, _IFLA_INFO_KIND = 3, 18, 1
_MESSAGE_HEADER = struct.Struct("=IHHII")  # length, type, flags, sequence, port
_LINK_HEADER = struct.Struct("=BxHiII")  # family, device type, index, flags, change

# linux/sockios.h, linux/if.h
_SIOCGIFFLAGS, _SIOCSIFFLAGS, _IFF_UP = 0x8913, 0x8914, 0x1
_INTERFACE_REQUEST = struct.Struct("16sh22x")


def create_vcan(name: str) -> None:
    """Add a virtual CAN interface, as `ip link add NAME type vcan`; raises OSError."""
    kind = _attribute(_IFLA_LINKINFO, _attribute(_IFLA_INFO_KIND, b"vcan\0"))
    link = _LINK_HEADER.pack(0, 0, 0, 0, 0)
    body = link + _attribute(_IFLA_IFNAME, name.encode() + b"\0") + kind
    size = _MESSAGE_HEADER.size + len(body)
    header = _MESSAGE_HEADER.pack(size, _RTM_NEWLINK, _REQUEST_ACK_CREATE_EXCLUSIVE, 1, 0)
    with socket.socket(socket.AF_NETLINK, socket.SOCK_RAW, socket.NETLINK_ROUTE) as netlink:
        netlink.send(header + body)
        answer = netlink.recv(4096)
    # The acknowledgement carries a negated errno right behind its header.
    start = _MESSAGE_HEADER.size
    code = -int.from_bytes(answer[start : start + 4], sys.byteorder, signed=True)
    if code != 0:
        raise OSError(code, f"create {name}: {os.strerror(code)}")


def set_up(name: str, *, up: bool = True) -> None:
    """Bring an interface up or down, as `ip link set NAME up`; raises OSError."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as handle:
        request = _INTERFACE_REQUEST.pack(name.encode(), 0)
        answer = fcntl.ioctl(handle, _SIOCGIFFLAGS, request)
        flags = _INTERFACE_REQUEST.unpack(answer)[1]
        flags = flags | _IFF_UP if up else flags & ~_IFF_UP
        fcntl.ioctl(handle, _SIOCSIFFLAGS, _INTERFACE_REQUEST.pack(name.encode(), flags))


def _attribute(kind: int, value: bytes) -> bytes:
    padding = b"\0" * (-len(value) % 4)
    return struct.pack("=HH", 4 + len(value), kind) + value + padding
