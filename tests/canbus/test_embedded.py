"""The embedded bus between real processes, and where it may go wrong."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

import can
import pytest

from tcs_hil.canbus.embedded import EmbeddedBus

FRAMES_EACH = 6_700  # three senders: 20 100 frames, each heard by two


class Peer:
    """A node in a process of its own."""

    def __init__(self):
        self.process = subprocess.Popen(
            [sys.executable, "-m", "tests.canbus.embedded_peer"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def tell(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def answer(self):
        return self.process.stdout.readline().strip()


@pytest.fixture
def start_peer():
    peers = []

    def start():
        peers.append(Peer())
        return peers[-1]

    yield start
    for peer in peers:
        peer.process.kill()
        peer.process.communicate()


@pytest.fixture
def open_bus():
    buses = []

    def open_one(**options):
        buses.append(EmbeddedBus("vcan0", **options))
        return buses[-1]

    yield open_one
    for bus in buses:
        bus.shutdown()


def message(data=b"", frame_id=0x90):
    return can.Message(arbitration_id=frame_id, data=data, is_extended_id=False)


def opened(peers):
    for peer in peers:
        peer.tell("open")
    assert [peer.answer() for peer in peers] == ["open"] * len(peers)
    return peers


def test_three_processes_lose_no_frame_and_keep_each_senders_order(start_peer):
    peers = opened([start_peer() for _ in range(3)])
    for own_id, peer in enumerate(peers):
        peer.tell(f"talk {own_id} {FRAMES_EACH} {2 * FRAMES_EACH}")
    for own_id, peer in enumerate(peers):
        heard = json.loads(peer.answer())
        others = {str(i): list(range(FRAMES_EACH)) for i in range(3) if i != own_id}
        assert heard == others


def test_nodes_that_open_at_the_same_moment_all_meet(start_peer):
    peers = [start_peer() for _ in range(5)]
    opened(peers)  # all are told before the first answers
    for own_id, peer in enumerate(peers):
        peer.tell(f"talk {own_id} 1 4")
    for own_id, peer in enumerate(peers):
        assert json.loads(peer.answer()) == {str(i): [0] for i in range(5) if i != own_id}


def test_a_killed_process_is_forgotten_and_the_others_go_on(start_peer, open_bus):
    victim, survivor = opened([start_peer(), start_peer()])
    bus = open_bus()
    survivor.tell("talk 1 0 500")
    for number in range(500):
        if number == 250:
            victim.process.kill()
            victim.process.wait()
        bus.send(message(number.to_bytes(4, "big")))
    assert json.loads(survivor.answer()) == {str(0x90): list(range(500))}


def test_what_a_killed_process_left_on_disk_is_swept_away(
    start_peer, open_bus, private_runtime_directory
):
    (victim,) = opened([start_peer()])
    victim.process.kill()
    victim.process.wait()
    sockets = list(private_runtime_directory.rglob("*.node"))
    assert len(sockets) == 1
    open_bus()
    assert not sockets[0].exists()


@pytest.mark.parametrize("notices_by", ["sending", "reading"])
def test_what_a_node_said_before_it_left_is_still_heard(open_bus, notices_by):
    reader, speaker = open_bus(), open_bus()
    reader.send(message(b"unread"))  # so that leaving resets the connection
    for number in range(10):
        speaker.send(message(bytes([number])))
    speaker.shutdown()
    if notices_by == "sending":
        reader.send(message(b"nobody"))
    assert [reader.recv(1.0).data[0] for _ in range(10)] == list(range(10))
    assert reader.recv(0.0) is None


def fill(bus):
    """Send until a reader is full; return how many frames fitted."""
    for count in range(100_000):
        try:
            bus.send(message(count.to_bytes(4, "big")), timeout=0)
        except can.CanTimeoutError:
            return count
    pytest.fail("the reader never filled up")


def test_a_full_reader_loses_frames_alone_and_they_are_counted(open_bus):
    sender, lazy = open_bus(), open_bus()
    count = fill(sender)
    eager = open_bus()
    sender.send(message(b"more"), timeout=0)  # not refused: somebody has it
    assert eager.recv(1.0).data == b"more"
    assert sender.dropped == 2
    heard = [lazy.recv(0.0) for _ in range(count + 1)]
    assert [int.from_bytes(msg.data, "big") for msg in heard[:-1]] == list(range(count))
    assert heard[-1] is None


def test_a_full_reader_is_waited_for_as_long_as_asked(open_bus):
    sender, _lazy = open_bus(), open_bus()
    fill(sender)
    start = time.monotonic()
    with pytest.raises(can.CanTimeoutError):
        sender.send(message(), timeout=0.05)
    assert time.monotonic() - start >= 0.05


def test_a_full_reader_that_reads_again_gets_every_frame(open_bus):
    sender, lazy = open_bus(), open_bus()
    count = fill(sender)
    with ThreadPoolExecutor() as pool:
        last = pool.submit(sender.send, message(count.to_bytes(4, "big")), timeout=10.0)
        heard = [lazy.recv(10.0) for _ in range(count + 1)]
        last.result()
    assert [int.from_bytes(msg.data, "big") for msg in heard] == list(range(count + 1))


def test_an_unwanted_frame_does_not_hide_the_wanted_one_behind_it(open_bus):
    sender = open_bus()
    reader = open_bus(can_filters=[{"can_id": 0x90, "can_mask": 0x7FF}])
    sender.send(message(b"unwanted", frame_id=0x91))
    sender.send(message(b"wanted"))
    assert reader.recv(0.0).data == b"wanted"


def test_reading_a_silent_bus_ends_with_the_timeout(open_bus):
    bus, start = open_bus(), time.monotonic()
    assert bus.recv(0.02) is None
    assert time.monotonic() - start >= 0.02


def test_own_frames_come_back_on_request_and_are_marked(open_bus):
    bus, other = open_bus(receive_own_messages=True), open_bus()
    bus.send(message(b"own"))
    other.send(message(b"other"))
    heard = {bytes(msg.data): msg.is_rx for msg in (bus.recv(1.0), bus.recv(1.0))}
    assert heard == {b"own": False, b"other": True}
    assert bus.recv(0.0) is None


def test_one_busy_node_does_not_starve_another(open_bus):
    reader, busy, quiet = open_bus(), open_bus(), open_bus()
    for _ in range(100):
        busy.send(message(b"busy"))
    quiet.send(message(b"quiet"))
    while quiet.recv(0.0):
        pass
    early = [bytes(reader.recv(1.0).data) for _ in range(10)]
    assert b"quiet" in early


def test_every_kind_of_classic_frame_survives_the_trip(open_bus):
    sender, reader = open_bus(), open_bus()
    for flags in (
        {"is_extended_id": True, "arbitration_id": 0x1FFFFFFF, "data": b"12345678"},
        {"is_extended_id": False, "is_remote_frame": True, "dlc": 5},
        {"is_extended_id": False, "is_error_frame": True, "data": b"\x01"},
    ):
        sent = can.Message(**flags)
        sender.send(sent)
        assert reader.recv(1.0).equals(sent, timestamp_delta=None, check_channel=False)


def test_can_fd_is_refused(open_bus):
    with pytest.raises(can.CanOperationError, match="classic CAN frames only"):
        open_bus().send(can.Message(is_fd=True, data=bytes(12)))


def test_channels_are_apart(open_bus):
    here = open_bus()
    with EmbeddedBus("vcan1") as elsewhere:
        elsewhere.send(message(b"there"))
        assert here.recv(0.0) is None


@pytest.mark.parametrize("name", ["", "a/b", ".."])
def test_a_channel_must_have_a_plain_name(name):
    with pytest.raises(can.CanInitializationError, match="cannot be the name"):
        EmbeddedBus(name)


def test_a_directory_others_can_enter_is_refused(private_runtime_directory):
    (private_runtime_directory / "tcs-hil").mkdir(mode=0o755)
    with pytest.raises(can.CanInitializationError, match="only this user can enter"):
        EmbeddedBus("vcan0")


def test_without_a_runtime_directory_nodes_meet_in_the_temporary_one(
    open_bus, monkeypatch, private_runtime_directory
):
    monkeypatch.delenv("XDG_RUNTIME_DIR")
    monkeypatch.setattr(tempfile, "tempdir", str(private_runtime_directory))
    open_bus()
    (place,) = private_runtime_directory.iterdir()
    assert place.name == f"tcs-hil-{os.getuid()}"
    assert place.stat().st_mode & 0o777 == 0o700


def test_a_path_too_long_for_a_socket_is_named(monkeypatch, private_runtime_directory):
    deep = private_runtime_directory / ("d" * 100)
    deep.mkdir()
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(deep))
    with pytest.raises(can.CanInitializationError, match=r"channel vcan0: .*too long"):
        EmbeddedBus("vcan0")


def test_shutting_down_twice_is_harmless(open_bus, private_runtime_directory):
    bus = open_bus()
    bus.shutdown()
    bus.shutdown()
    assert list(private_runtime_directory.rglob("*.node")) == []
