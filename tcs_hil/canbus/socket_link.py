"""The short way to SocketCAN: the socket that python-can has opened, read and written directly.

No message object, no float time stamp, and the one thing python-can does not
tell: how many frames the kernel threw away because nobody had read them.
"""

from __future__ import annotations

import select
import socket
import struct
import time

from can.interfaces.socketcan import constants

from tcs_hil.canbus.frame import Frame, PortCounters
from tcs_hil.canbus.health import BusHealth
from tcs_hil.canbus.link import DRAIN_LIMIT
from tcs_hil.canbus.stamps import RealtimeStamps

PACKET = struct.Struct("=IB3x8s")
"""``struct can_frame``: identifier with flags, length, data."""
TIMESPEC = struct.Struct("@ll")
DROP_COUNT = struct.Struct("=I")
ANCILLARY_BYTES = socket.CMSG_SPACE(TIMESPEC.size) + socket.CMSG_SPACE(DROP_COUNT.size)
SO_RXQ_OVFL = 40  # asm-generic/socket.h; not in the socket module
ID_MASK = 0x7FF
UINT32_MASK = 0xFFFF_FFFF


class SocketLink:
    """A CAN_RAW socket with kernel time stamps and its drop counter.

    The socket belongs to whoever opened it, who must no longer read from it:
    frames come with one more control message from here on.  Source:
    Documentation/networking/can.rst, socket(7).
    """

    def __init__(
        self, can_socket: socket.socket, counters: PortCounters, health: BusHealth
    ) -> None:
        can_socket.setsockopt(socket.SOL_SOCKET, constants.SO_TIMESTAMPNS, 1)
        can_socket.setsockopt(socket.SOL_SOCKET, SO_RXQ_OVFL, 1)
        self._socket = can_socket
        self._counters = counters
        self._health = health
        self._stamps = RealtimeStamps()
        self._lost = 0

    def drain(self, frames: list[Frame]) -> None:
        """Append what has come, oldest first."""
        self._stamps.begin()
        try:
            for _ in range(DRAIN_LIMIT):
                self._receive(frames)
        except BlockingIOError:
            self._stamps.end()

    def send(self, frame_id: int, data: bytes, timeout_s: float) -> None:
        """Send a frame with an 11-bit identifier."""
        packet = PACKET.pack(frame_id, len(data), data)
        try:
            self._socket.send(packet, socket.MSG_DONTWAIT)
        except BlockingIOError:
            _, writable, _ = select.select([], [self._socket], [], timeout_s)
            if not writable:
                raise
            self._socket.send(packet, socket.MSG_DONTWAIT)

    def wait(self, timeout_s: float) -> bool:
        """Sleep until something can be received."""
        readable, _, _ = select.select([self._socket], [], [], timeout_s)
        return bool(readable)

    def _receive(self, frames: list[Frame]) -> None:
        packet, ancillary, _, _ = self._socket.recvmsg(
            PACKET.size, ANCILLARY_BYTES, socket.MSG_DONTWAIT
        )
        realtime_ns = self._read(ancillary)
        flags_and_id, length, data = PACKET.unpack(packet)
        if flags_and_id & constants.CAN_ERR_FLAG:
            self._counters.error_frames += 1
            self._health.error_frame(flags_and_id & constants.MSK_ARBID, data[:length])
        elif self._is_ours(flags_and_id):
            self._health.heard()
            stamp_ns = self._stamps.moved_ns(realtime_ns)
            frames.append(Frame(flags_and_id & ID_MASK, data[:length], stamp_ns))

    def _read(self, ancillary: list[tuple[int, int, bytes]]) -> int:
        """Note the drop counter and return the time stamp, CLOCK_REALTIME."""
        realtime_ns = None
        for _, kind, value in ancillary:
            if kind == constants.SO_TIMESTAMPNS:
                seconds, nanoseconds = TIMESPEC.unpack(value)
                realtime_ns = seconds * 1_000_000_000 + nanoseconds
            elif kind == SO_RXQ_OVFL:
                (lost,) = DROP_COUNT.unpack(value)
                # The kernel counts in 32 bits since the socket was made; the port for ever.
                if lost != self._lost:
                    self._counters.lost += (lost - self._lost) & UINT32_MASK
                    self._lost = lost
                    self._health.overflowed()
        return time.time_ns() if realtime_ns is None else realtime_ns

    def _is_ours(self, flags_and_id: int) -> bool:
        if flags_and_id & constants.CAN_RTR_FLAG:
            self._counters.remote_frames += 1
        elif flags_and_id & constants.CAN_EFF_FLAG:
            self._counters.dropped += 1
        else:
            self._counters.rx += 1
            return True
        return False
