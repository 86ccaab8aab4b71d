"""A CAN bus between processes of one user, for machines without SocketCAN.

A python-can plug-in (``interface="embedded"``) over AF_UNIX sockets: no kernel
module, privilege, network or broker.  Every node is linked to every other by a
SOCK_SEQPACKET connection, so frames arrive whole, once, and in the order of
their sender, and a sender waits for a slow reader instead of losing frames.
"""

from __future__ import annotations

import errno
import select
import socket
import time
from typing import Any

import can
from can.typechecking import CanFilters

from tcs_hil.canbus import embedded_packet
from tcs_hil.canbus.embedded_channel import Channel

DEFAULT_TIMEOUT_S = 1.0
SEND_BUFFER_BYTES = 1 << 20
_GONE = (errno.EPIPE, errno.ECONNRESET, errno.ENOTCONN)


class EmbeddedBus(can.BusABC):
    """One node on an embedded channel.

    ``Message.timestamp`` is the moment of sending on CLOCK_MONOTONIC in seconds.
    ``dropped`` counts the frames a full reader did not get.  A node must read, or
    others wait for it.
    """

    def __init__(
        self,
        channel: str,
        receive_own_messages: bool = False,
        can_filters: CanFilters | None = None,
        **kwargs: Any,
    ) -> None:
        """Join ``channel``, creating it if nobody is there.

        Raises:
            can.CanInitializationError: The channel's directory or socket cannot be used.
        """
        self._name = channel
        self.channel_info = f"embedded {channel}"
        self.dropped = 0
        self._channel = Channel(channel)
        self._epoll = select.epoll()
        self._sources: dict[int, socket.socket] = {}
        self._sinks: list[socket.socket] = []
        self._epoll.register(self._channel.listener, select.EPOLLIN)
        for peer in self._channel.peers:
            self._welcome(peer)
        self._own_fd = self._echo() if receive_own_messages else -1
        super().__init__(channel=channel, can_filters=can_filters, **kwargs)

    def fileno(self) -> int:
        """Descriptor that is readable while a frame or a new node is waiting."""
        return self._epoll.fileno()

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Hand a frame to every other node.

        A full reader is waited for, ``DEFAULT_TIMEOUT_S`` unless ``timeout`` says
        otherwise, 0 being not at all; then the frame is dropped for that reader only.
        As on a wire, one that does not read harms only itself.

        Raises:
            can.CanTimeoutError: Every reader stayed full: nobody has the frame.
            can.CanOperationError: The frame is not a classic CAN frame.
        """
        packet = embedded_packet.pack(msg, time.monotonic_ns())
        self._accept()
        full = [sink for sink in self._sinks.copy() if not self._offer(sink, packet)]
        if full:
            wait_s = DEFAULT_TIMEOUT_S if timeout is None else timeout
            self._insist(full, packet, time.monotonic() + wait_s)

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        deadline = None if timeout is None else time.monotonic() + timeout
        while True:
            # One event at a time: epoll then takes the nodes in turn, so none starves another.
            while events := self._epoll.poll(0, 1):
                msg = self._read(events[0][0])
                # Filtered here, as recv would take one unwanted frame for an empty bus.
                if msg is not None and self._matches_filters(msg):
                    return msg, True
            wait_s = None if deadline is None else deadline - time.monotonic()
            if wait_s is not None and wait_s <= 0:
                return None, True
            # select keeps the microseconds that epoll would round up to milliseconds.
            select.select([self._epoll], [], [], wait_s)

    def shutdown(self) -> None:
        """Leave the channel; frames already sent still reach their readers."""
        if self._is_shutdown:
            return
        super().shutdown()
        self._channel.leave()
        for link in {*self._sources.values(), *self._sinks}:
            link.close()
        self._epoll.close()

    def _welcome(self, peer: socket.socket) -> None:
        peer.setblocking(False)
        peer.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER_BYTES)
        self._sinks.append(peer)
        self._listen_to(peer)

    def _listen_to(self, source: socket.socket) -> None:
        self._sources[source.fileno()] = source
        self._epoll.register(source, select.EPOLLIN)

    def _echo(self) -> int:
        near, far = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._welcome(near)
        far.setblocking(False)
        self._listen_to(far)
        return far.fileno()

    def _accept(self) -> None:
        while True:
            try:
                peer, _ = self._channel.listener.accept()
            except BlockingIOError:
                return
            self._welcome(peer)

    def _read(self, fd: int) -> can.Message | None:
        if fd == self._channel.listener.fileno():
            self._accept()
            return None
        source = self._sources[fd]
        try:
            packet = source.recv(embedded_packet.SIZE_MAX + 1)
        except ConnectionResetError:
            # It left without reading everything of ours; what it sent is still queued.
            return None
        if not packet:
            self._forget(source)
            return None
        return embedded_packet.unpack(packet, self._name, is_rx=fd != self._own_fd)

    def _offer(self, sink: socket.socket, packet: bytes) -> bool:
        """Hand over a packet; False if the sink is full, True if it is done with."""
        try:
            sink.send(packet)
        except BlockingIOError:
            return False
        except OSError as error:
            if error.errno not in _GONE:
                raise can.CanOperationError(
                    f"cannot send on {self.channel_info}: {error}"
                ) from error
            # Deaf from now on, but what it said before it died is still to be read.
            self._sinks.remove(sink)
        return True

    def _insist(self, full: list[socket.socket], packet: bytes, deadline: float) -> None:
        while full:
            wait_s = deadline - time.monotonic()
            if wait_s <= 0:
                self.dropped += len(full)
                if len(full) == len(self._sinks):
                    raise can.CanTimeoutError(f"every reader of {self.channel_info} is full")
                return
            _, writable, _ = select.select([], full, [], wait_s)
            full = [sink for sink in full if sink not in writable or not self._offer(sink, packet)]

    def _forget(self, source: socket.socket) -> None:
        self._epoll.unregister(source)
        del self._sources[source.fileno()]
        if source in self._sinks:
            self._sinks.remove(source)
        source.close()
