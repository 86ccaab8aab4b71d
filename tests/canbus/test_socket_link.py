"""The short way to SocketCAN, over UDP: its sockets stamp and count drops in the same way."""

from __future__ import annotations

import socket
import time
from contextlib import ExitStack

import pytest
from can.interfaces.socketcan import constants

from tcs_hil.canbus.frame import Frame, PortCounters
from tcs_hil.canbus.health import BusHealth
from tcs_hil.canbus.link import DRAIN_LIMIT
from tcs_hil.canbus.socket_link import PACKET, SocketLink
from tcs_hil.signals import BusCondition


class Wire:
    """A link and the far end of its socket."""

    def __init__(self, near: socket.socket, far: socket.socket) -> None:
        self.near, self.far = near, far
        self.counters = PortCounters()
        self.health = BusHealth()
        self.link = SocketLink(near, self.counters, self.health)

    def hear(self, flags_and_id: int, data: bytes = b"") -> None:
        self.far.send(PACKET.pack(flags_and_id, len(data), data))

    def drained(self) -> list[Frame]:
        frames: list[Frame] = []
        self.link.drain(frames)
        return frames


@pytest.fixture
def wire():
    with ExitStack() as stack:
        near, far = (
            stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) for _ in "ab"
        )
        for end in (near, far):
            end.bind(("127.0.0.1", 0))
        near.connect(far.getsockname())
        far.connect(near.getsockname())
        yield Wire(near, far)


def test_frames_come_out_oldest_first_with_their_own_length(wire):
    wire.hear(0x90, b"\x01\x02")
    wire.hear(0x7FF)
    wire.hear(0x00, bytes(range(8)))
    assert [(frame.frame_id, frame.data) for frame in wire.drained()] == [
        (0x90, b"\x01\x02"),
        (0x7FF, b""),
        (0x00, bytes(range(8))),
    ]
    assert wire.drained() == []
    assert wire.counters == PortCounters(rx=3)


def test_a_stamp_is_when_the_frame_came_and_not_when_it_was_read(wire):
    wire.drained()
    before_ns = time.monotonic_ns()
    wire.hear(0x90)
    after_ns = time.monotonic_ns()
    time.sleep(0.02)  # the very thing: the frame lies there for longer than the tolerance below
    (frame,) = wire.drained()
    # Two clocks are read one after the other to move a stamp over: allow for a preemption.
    assert before_ns - 5_000_000 <= frame.stamp_ns <= after_ns + 5_000_000


def test_frames_nobody_speaks_are_counted_by_kind(wire):
    wire.hear(constants.CAN_ERR_FLAG | 0x04, bytes(8))
    wire.hear(constants.CAN_RTR_FLAG | 0x90)
    wire.hear(constants.CAN_EFF_FLAG | 0x12345678)
    wire.hear(0x90, b"good")
    assert [frame.data for frame in wire.drained()] == [b"good"]
    assert wire.counters == PortCounters(rx=1, error_frames=1, remote_frames=1, dropped=1)


def test_error_frames_are_read_and_any_frame_is_survived(wire):
    wire.hear(0xFFFF_FFFF)  # an error frame of every class at once
    wire.far.send(PACKET.pack(0x90, 255, b"longer?!"))
    assert [frame.data for frame in wire.drained()] == [b"longer?!"]
    # Who hears is not off the bus.
    assert [wire.health.condition(), wire.health.condition()] == [
        BusCondition.BUS_OFF,
        BusCondition.OK,
    ]


def test_a_babbling_node_is_cut_off_until_the_next_drain(wire):
    wire.near.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
    for _ in range(DRAIN_LIMIT + 10):
        wire.hear(0x90)
    wire.link.drain(frames := [])
    assert len(frames) == DRAIN_LIMIT
    assert len(wire.drained()) == wire.counters.rx - DRAIN_LIMIT


def test_what_the_kernel_had_no_room_for_is_counted(wire):
    wire.near.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1)  # the smallest there is
    sent = 100
    for _ in range(sent):
        wire.hear(0x90)
    received = len(wire.drained())
    wire.hear(0x90)  # the count travels with a frame that came after the loss
    wire.drained()
    assert received < sent
    assert wire.counters.lost == sent - received
    assert [wire.health.condition(), wire.health.condition()] == [
        BusCondition.OVERFLOW,
        BusCondition.OK,
    ]


def test_losses_add_up_over_several_floods(wire):
    wire.near.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1)
    for _ in range(2):
        for _ in range(50):
            wire.hear(0x90)
        wire.drained()
    wire.hear(0x90)
    wire.drained()
    assert wire.counters.rx + wire.counters.lost == 101


def test_what_is_sent_is_a_frame_of_the_kernel(wire):
    wire.link.send(0x123, b"\xde\xad", 0.0)
    assert wire.far.recv(100) == bytes.fromhex("23010000 02000000 dead000000000000")


def test_waiting_ends_with_the_frame_or_with_the_time(wire):
    assert not wire.link.wait(0.0)
    wire.hear(0x90)
    assert wire.link.wait(5.0)


def test_a_full_socket_is_waited_for_as_long_as_allowed():
    near, far = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
    with near, far:
        link = SocketLink(near, PortCounters(), BusHealth())
        far.setblocking(False)
        with pytest.raises(BlockingIOError):
            fill(link)
        assert far.recv(100) == PACKET.pack(0x90, 0, b"")


def fill(link: SocketLink) -> None:
    for _ in range(10_000):
        link.send(0x90, b"", 0.0)
