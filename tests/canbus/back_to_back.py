"""What every bus must do, whatever carries it; run on the embedded bus and on a real vcan0."""

from __future__ import annotations

import time

import can
import pytest

from tcs_hil.canbus.port import CanPort, Frame
from tcs_hil.signals import BusCondition

PATIENCE_S = 5.0


def error_frame(error_class: int, data: bytes = bytes(8)) -> can.Message:
    """What a CAN controller's driver would put among the frames; a virtual bus carries it too."""
    return can.Message(
        arbitration_id=error_class,
        data=data.ljust(8, b"\0"),
        is_error_frame=True,
        is_extended_id=False,
    )


def collect(port: CanPort, count: int) -> list[Frame]:
    """Receive until ``count`` frames are there; fewer only if the patience runs out."""
    frames: list[Frame] = []
    deadline = time.monotonic() + PATIENCE_S
    while len(frames) < count and port.wait(max(deadline - time.monotonic(), 0.0)):
        frames += port.receive()
    return frames


class BackToBack:
    """Two nodes on one bus; a subclass says how a node is opened in ``open_node``."""

    def open_node(self) -> can.BusABC:
        raise NotImplementedError

    @pytest.fixture
    def left(self):
        port = CanPort(self.open_node())
        yield port
        port.close()

    @pytest.fixture
    def right(self, left):
        port = CanPort(self.open_node())
        yield port
        port.close()

    @pytest.fixture
    def stranger(self, right):
        with self.open_node() as bus:
            yield bus

    @pytest.mark.parametrize("data", [b"", b"\x00", b"\xff" * 8])
    @pytest.mark.parametrize("frame_id", [0, 0x90, 0x7FF])
    def test_a_frame_arrives_as_it_was_sent(self, left, right, frame_id, data):
        assert left.send(frame_id, data)
        (frame,) = collect(right, 1)
        assert (frame.frame_id, frame.data) == (frame_id, data)

    def test_frames_arrive_in_the_order_they_were_sent(self, left, right):
        sent = [bytes([number]) for number in range(200)]
        for data in sent:
            assert left.send(0x90, data)
        assert [frame.data for frame in collect(right, 200)] == sent

    def test_nobody_hears_himself(self, left, right):
        assert left.send(0x90, b"mine")
        assert len(collect(right, 1)) == 1
        assert left.receive() == []

    def test_everybody_else_hears_a_frame(self, left, right, stranger):
        stranger.send(can.Message(arbitration_id=0x90, data=b"all", is_extended_id=False))
        assert [frame.data for frame in collect(left, 1) + collect(right, 1)] == [b"all"] * 2

    def test_both_directions_work_at_once(self, left, right):
        assert left.send(0x90, b"there")
        assert right.send(0x91, b"back")
        assert collect(left, 1)[0].data == b"back"
        assert collect(right, 1)[0].data == b"there"

    def test_waiting_on_a_silent_bus_ends_with_the_timeout(self, left, right):
        start = time.monotonic()
        assert not right.wait(0.02)
        assert time.monotonic() - start >= 0.02
        assert right.receive() == []

    def test_stamps_are_on_the_monotonic_clock_between_sending_and_receiving(self, left, right):
        before_ns = time.monotonic_ns()
        assert left.send(0x90, b"")
        (frame,) = collect(right, 1)
        # The stamp went through a float of seconds and, on SocketCAN, through another clock.
        slack_ns = 50_000
        assert before_ns - slack_ns <= frame.stamp_ns <= time.monotonic_ns() + slack_ns

    @pytest.mark.parametrize(
        ("message", "counter"),
        [
            (can.Message(arbitration_id=1, is_extended_id=False, is_remote_frame=True, dlc=2),
             "remote_frames"),
            (can.Message(arbitration_id=1 << 20, data=b"x", is_extended_id=True), "dropped"),
        ],
        ids=["remote", "extended"],
    )  # fmt: skip
    def test_a_strange_frame_is_counted_and_passed_over(self, right, stranger, message, counter):
        stranger.send(message)
        stranger.send(can.Message(arbitration_id=0x90, data=b"ok", is_extended_id=False))
        assert [frame.data for frame in collect(right, 1)] == [b"ok"]
        assert getattr(right.counters, counter) == 1
        assert right.counters.rx == 1

    def test_error_frames_tell_the_condition_of_the_bus(self, right, stranger):
        for message, condition in (
            (error_frame(0x004, b"\0\x30"), BusCondition.ERROR_PASSIVE),
            (error_frame(0x040), BusCondition.BUS_OFF),
        ):
            stranger.send(message)
            assert right.wait(PATIENCE_S)
            assert right.receive() == []
            assert [right.condition(), right.condition()] == [condition] * 2
        stranger.send(error_frame(0x100))
        assert right.wait(PATIENCE_S)
        assert right.receive() == []
        assert right.condition() is BusCondition.OK
        assert right.counters.error_frames == 3

    def test_who_uses_the_identifier_of_another_is_heard_by_him(self, left, stranger):
        assert left.send(0x90, b"mine")
        stranger.send(can.Message(arbitration_id=0x90, data=b"not mine", is_extended_id=False))
        assert [frame.data for frame in collect(left, 1)] == [b"not mine"]

    def test_filters_mean_what_they_mean_in_python_can(self, left, stranger):
        stranger.set_filters([{"can_id": 0x90, "can_mask": 0x7FF, "extended": False}])
        assert left.send(0x91, b"not this")
        assert left.send(0x90, b"but this")
        assert stranger.recv(PATIENCE_S).data == b"but this"

    def test_a_node_that_left_is_not_missed(self, left, right, stranger):
        stranger.shutdown()
        assert left.send(0x90, b"still")
        assert len(collect(right, 1)) == 1
