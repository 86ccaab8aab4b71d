"""Our port on a real vcan0 among programs that are not ours, and with its link pulled."""

import socket
import time
from collections.abc import Callable, Iterator

import can
import pytest

from tcs_hil.canbus.bus import open_bus
from tcs_hil.canbus.port import CanPort

from .conftest import CHANNEL, PATIENCE_S, Candump, Interface

StartCandump = Callable[[int], Candump]
SendFrame = Callable[[str], None]
CLOCKS_APART_NS = 5_000_000  # two clocks are read one after the other to move a stamp over


def reopened() -> can.BusABC:
    return open_bus("auto", CHANNEL)[0]


@pytest.fixture
def port() -> Iterator[CanPort]:
    port = CanPort(reopened(), reopen=reopened)
    yield port
    port.close()


def received(port: CanPort) -> list[tuple[int, bytes]]:
    assert port.wait(PATIENCE_S)
    return [(frame.frame_id, frame.data) for frame in port.receive()]


def test_auto_takes_socketcan_where_the_kernel_has_it() -> None:
    bus, description = open_bus("auto", CHANNEL)
    bus.shutdown()
    assert description == "socketcan vcan0"


def test_candump_sees_what_the_port_sends(port: CanPort, candump: StartCandump) -> None:
    dump = candump(3)
    for frame_id, data in ((0x001, b""), (0x123, b"\xde\xad"), (0x7FF, bytes(range(8)))):
        assert port.send(frame_id, data)
    assert dump.frames() == ["001#", "123#DEAD", "7FF#0001020304050607"]


def test_the_port_receives_what_cansend_sends(port: CanPort, cansend: SendFrame) -> None:
    cansend("123#DEADBEEF")
    assert received(port) == [(0x123, b"\xde\xad\xbe\xef")]


def test_remote_and_extended_frames_of_strangers_are_counted_and_dropped(
    port: CanPort, cansend: SendFrame
) -> None:
    for frame in ("123#R", "12345678#AA", "321#01"):
        cansend(frame)
    assert received(port) == [(0x321, b"\x01")]
    assert (port.counters.remote_frames, port.counters.dropped) == (1, 1)


def test_frames_the_kernel_had_no_room_for_are_counted(cansend: SendFrame) -> None:
    bus, sender = reopened(), CanPort(reopened())
    bus.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1)  # the smallest there is
    port, sent = CanPort(bus), 200
    for _ in range(sent):
        assert sender.send(0x123, b"")
    received = len(port.receive())
    cansend("321#04")  # the count travels with the first frame that came after the loss
    port.receive()
    assert received < sent
    assert port.counters.lost == sent - received
    port.close()
    sender.close()


def test_a_frame_is_stamped_when_it_came_and_not_when_it_is_read(
    port: CanPort, cansend: SendFrame
) -> None:
    before_ns = time.monotonic_ns()
    cansend("123#00")
    after_ns = time.monotonic_ns()
    time.sleep(0.05)
    (frame,) = port.receive()
    assert before_ns <= frame.stamp_ns <= after_ns + CLOCKS_APART_NS


def test_a_port_outlives_its_link_going_down_and_up(
    port: CanPort, vcan0: Interface, candump: StartCandump, cansend: SendFrame
) -> None:
    vcan0.down()
    assert not port.send(0x123, b"\x01")
    assert port.receive() == []
    assert port.counters.tx_errors == 1

    vcan0.up()
    dump = candump(2)
    assert port.send(0x123, b"\x02")
    cansend("321#03")
    assert dump.frames() == ["123#02", "321#03"]
    assert received(port) == [(0x321, b"\x03")]


def test_a_port_finds_the_successor_of_a_removed_interface(
    port: CanPort, vcan0: Interface, cansend: SendFrame
) -> None:
    vcan0.remove()
    assert not port.send(0x123, b"\x01")
    vcan0.add()
    port.receive()  # takes the new interface into use
    cansend("321#04")
    assert received(port) == [(0x321, b"\x04")]
    assert port.counters.reopened == 1
