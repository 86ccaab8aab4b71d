"""One frame of the embedded bus as bytes."""

from __future__ import annotations

import struct

import can

_HEADER = struct.Struct("=IBq")  # identifier and flags as in SocketCAN, dlc, stamp in ns
_EXTENDED, _REMOTE, _ERROR = 1 << 31, 1 << 30, 1 << 29
_ID_MASK = _ERROR - 1
_DATA_MAX = 8
SIZE_MAX = _HEADER.size + _DATA_MAX


def pack(msg: can.Message, stamp_ns: int) -> bytes:
    """Serialise a classic frame sent at ``stamp_ns``.

    Raises:
        can.CanOperationError: The frame is CAN FD or longer than eight bytes.
    """
    if msg.is_fd or len(msg.data) > _DATA_MAX:
        raise can.CanOperationError("the embedded bus carries classic CAN frames only")
    flags = (
        _EXTENDED * msg.is_extended_id | _REMOTE * msg.is_remote_frame | _ERROR * msg.is_error_frame
    )
    return _HEADER.pack(msg.arbitration_id | flags, msg.dlc, stamp_ns) + msg.data


def unpack(packet: bytes, channel: str, *, is_rx: bool) -> can.Message | None:
    """Rebuild the frame; its timestamp is the moment of sending in seconds.

    None for bytes that no node of this bus can have sent.
    """
    if not _HEADER.size <= len(packet) <= SIZE_MAX:
        return None
    can_id, dlc, stamp_ns = _HEADER.unpack_from(packet)
    return can.Message(
        timestamp=stamp_ns * 1e-9,
        arbitration_id=can_id & _ID_MASK,
        is_extended_id=bool(can_id & _EXTENDED),
        is_remote_frame=bool(can_id & _REMOTE),
        is_error_frame=bool(can_id & _ERROR),
        channel=channel,
        dlc=dlc,
        data=packet[_HEADER.size :],
        is_rx=is_rx,
    )
