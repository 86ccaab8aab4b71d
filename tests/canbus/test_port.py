"""The port on a bus that does everything a bus should not do."""

from __future__ import annotations

import errno
import time
from collections import deque
from contextlib import closing

import can
import pytest

from tcs_hil.canbus.port import DRAIN_LIMIT, CanPort, PortCounters, open_port
from tcs_hil.errors import BusError
from tcs_hil.signals import BusCondition


class ScriptedBus(can.BusABC):
    """Plays back messages and errors; cannot be polled, like some USB adapters."""

    def __init__(self, *script, send_error=None):
        super().__init__(channel="scripted")
        self.script = deque(script)
        self.send_error = send_error
        self.sent = []

    def send(self, msg, timeout=None):
        if self.send_error is not None:
            raise self.send_error
        self.sent.append((msg.arbitration_id, bytes(msg.data), msg.is_extended_id, timeout))

    def _recv_internal(self, timeout):
        if not self.script:
            return None, False
        step = self.script.popleft()
        if isinstance(step, Exception):
            raise step
        return step, False

    def fileno(self):
        raise NotImplementedError


def message(data=b"", **options):
    return can.Message(**{"arbitration_id": 0x90, "is_extended_id": False, "data": data, **options})


def operation_error(code):
    return can.CanOperationError("scripted", code)


def test_frames_come_out_oldest_first():
    port = CanPort(ScriptedBus(message(b"a"), message(b"b", arbitration_id=0x91)))
    assert [(f.frame_id, f.data) for f in port.receive()] == [(0x90, b"a"), (0x91, b"b")]
    assert port.receive() == []


def test_frames_nobody_speaks_are_counted_by_kind():
    port = CanPort(
        ScriptedBus(
            message(is_error_frame=True),
            message(is_remote_frame=True),
            message(is_extended_id=True),
            message(is_fd=True),
            message(b"good"),
        )
    )
    assert [frame.data for frame in port.receive()] == [b"good"]
    assert port.counters == PortCounters(rx=1, error_frames=1, remote_frames=1, dropped=2)


def test_a_babbling_node_is_cut_off_until_the_next_drain():
    port = CanPort(ScriptedBus(*[message()] * (DRAIN_LIMIT + 10)))
    assert len(port.receive()) == DRAIN_LIMIT
    assert len(port.receive()) == 10


@pytest.mark.parametrize("error", [operation_error(errno.ENETDOWN), OSError(errno.EIO, "odd")])
def test_an_error_while_receiving_ends_the_drain_and_is_counted(error):
    port = CanPort(ScriptedBus(message(b"before"), error, message(b"after")))
    assert [frame.data for frame in port.receive()] == [b"before"]
    assert [frame.data for frame in port.receive()] == [b"after"]
    assert port.counters.rx_errors == 1


@pytest.mark.parametrize(
    "error", [operation_error(errno.ENOBUFS), operation_error(None), OSError(errno.EIO, "odd")]
)
def test_an_error_while_sending_is_counted(error):
    port = CanPort(ScriptedBus(send_error=error))
    assert not port.send(0x90, b"")
    assert (port.counters.tx, port.counters.tx_errors) == (0, 1)


def test_a_frame_is_sent_with_an_11_bit_identifier_and_the_ports_patience():
    bus = ScriptedBus()
    port = CanPort(bus, send_timeout_s=0.5)
    assert port.send(0x90, b"x")
    assert bus.sent == [(0x90, b"x", False, 0.5)]
    assert port.counters.tx == 1


def test_waiting_works_on_a_bus_that_cannot_be_polled():
    port = CanPort(ScriptedBus(message(b"a"), message(b"b")))
    assert port.wait(1.0)
    assert port.wait(1.0)
    assert [frame.data for frame in port.receive()] == [b"a", b"b"]
    assert not port.wait(0.0)


def test_stamps_of_an_unknown_interface_are_the_moment_of_reading():
    before_ns = time.monotonic_ns()
    (frame,) = CanPort(ScriptedBus(message(timestamp=3.0))).receive()
    assert before_ns <= frame.stamp_ns <= time.monotonic_ns()


@pytest.mark.parametrize("code", [errno.ENODEV, errno.ENXIO])
def test_a_removed_interface_is_reopened(code):
    gone = ScriptedBus(operation_error(code))
    port = CanPort(gone, reopen=lambda: ScriptedBus(message(b"back")))
    assert port.receive() == []
    assert [frame.data for frame in port.receive()] == [b"back"]
    assert port.counters.reopened == 1


def test_one_who_only_waits_and_sends_gets_his_interface_back_too():
    gone = ScriptedBus(send_error=operation_error(errno.ENODEV))
    port = CanPort(gone, reopen=lambda: ScriptedBus(message(b"back")))
    assert not port.send(0x90, b"")
    assert port.wait(0.0)
    assert [frame.data for frame in port.receive()] == [b"back"]


def test_an_interface_that_is_merely_down_is_not_reopened():
    port = CanPort(ScriptedBus(operation_error(errno.ENETDOWN)), reopen=ScriptedBus)
    port.receive()
    port.receive()
    assert port.counters.reopened == 0


def test_reopening_is_tried_again_but_not_in_every_tick():
    attempts = []

    def reopen():
        attempts.append(time.monotonic_ns())
        raise BusError("still gone")

    port = CanPort(ScriptedBus(operation_error(errno.ENODEV)), reopen=reopen)
    for _ in range(50):
        port.receive()
    assert len(attempts) == 1


def test_without_a_way_to_reopen_the_port_goes_on_counting():
    port = CanPort(ScriptedBus(*[operation_error(errno.ENODEV)] * 3))
    assert [port.receive() for _ in range(3)] == [[], [], []]
    assert port.counters.rx_errors == 3


@pytest.mark.parametrize(
    ("code", "condition"),
    [
        (errno.ENOBUFS, BusCondition.SEND_FAILED),
        (None, BusCondition.SEND_FAILED),
        (errno.ENETDOWN, BusCondition.DOWN),
        (errno.ENODEV, BusCondition.DOWN),
        (errno.ENXIO, BusCondition.DOWN),
    ],
)
def test_a_send_that_failed_is_a_condition_of_the_bus(code, condition):
    port = CanPort(ScriptedBus(send_error=operation_error(code)))
    assert port.condition() is BusCondition.OK
    port.send(0x90, b"")
    assert port.condition() is condition


def test_a_link_found_down_while_receiving_is_down_until_a_frame_could_be_sent():
    port = CanPort(ScriptedBus(operation_error(errno.ENETDOWN)))
    port.receive()
    assert [port.condition(), port.condition()] == [BusCondition.DOWN] * 2
    port.send(0x90, b"")
    assert port.condition() is BusCondition.OK


def test_an_odd_error_while_receiving_is_no_condition_as_late_inputs_speak_for_it():
    port = CanPort(ScriptedBus(OSError(errno.EIO, "odd")))
    port.receive()
    assert port.condition() is BusCondition.OK


def test_error_frames_of_an_interface_with_a_language_of_its_own_are_only_counted():
    port = CanPort(ScriptedBus(message(bytes(8), arbitration_id=0x040, is_error_frame=True)))
    port.receive()
    assert (port.condition(), port.counters.error_frames) == (BusCondition.OK, 1)


def test_a_port_is_opened_like_a_bus():
    port, description = open_port("virtual", "somewhere", send_timeout_s=0.1)
    peer, _ = open_port("virtual", "somewhere")
    with closing(port), closing(peer):
        assert description == "virtual somewhere"
        assert port.send(0x90, b"x")
        assert [frame.data for frame in peer.receive()] == [b"x"]
