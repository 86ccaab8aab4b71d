"""A bus that goes wrong in the middle of a manoeuvre: seen, survived, and control comes back."""

from __future__ import annotations

import random
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import can
import numpy as np
import pytest

from tcs_hil.canbus.bus import open_bus
from tcs_hil.canbus.port import CanPort
from tcs_hil.signals import BusCondition, TcsState
from tests.canbus.back_to_back import error_frame

from .conftest import CHANNEL, Interface
from .drive import Drive

LIMIT_ID = 0x090
PASSIVE = error_frame(0x004, b"\0\x30")
STUFF_ERROR = error_frame(0x008 | 0x080, b"\0\0\x04")  # a violation of the protocol, on the wire
BUS_OFF, RESTARTED = error_frame(0x040), error_frame(0x100)

pytestmark = pytest.mark.simulated_time


@pytest.fixture
def drive(tmp_path: Path) -> Iterator[Drive]:
    drive = Drive(tmp_path, "pi")
    yield drive
    drive.clean_up()


@pytest.fixture
def moving(drive: Drive) -> Drive:
    """In the manoeuvre, with control ACTIVE."""
    drive.start_service()
    drive.start_emulator()
    drive.await_active()
    return drive


@pytest.fixture
def stranger() -> Iterator[can.BusABC]:
    bus, _ = open_bus("socketcan", CHANNEL)
    with bus:
        yield bus


def newest(drive: Drive) -> int:
    return int(drive.ticks()["number"][-1])


def conditions(drive: Drive) -> set[BusCondition]:
    return {BusCondition(value) for value in np.unique(drive.ticks()["bus_condition"])}


def test_a_link_that_is_down_is_known_and_control_returns_with_it(
    moving: Drive, vcan0: Interface
) -> None:
    vcan0.down()
    moving.await_condition(BusCondition.DOWN)
    time.sleep(0.2)
    assert moving.ticks()["bus_condition"][-1] == BusCondition.DOWN
    vcan0.up()
    ticks = moving.await_active(after=newest(moving))
    assert ticks["bus_condition"][-1] == BusCondition.OK
    assert TcsState.FAULT in ticks["state"]
    assert not ticks["failed"].any()


def test_both_sides_find_the_successor_of_a_removed_interface(
    moving: Drive, vcan0: Interface
) -> None:
    vcan0.remove()
    moving.await_condition(BusCondition.DOWN)
    vcan0.add()
    ticks = moving.await_active(after=newest(moving))
    assert ticks["bus_condition"][-1] == BusCondition.OK


def test_a_controller_that_becomes_passive_is_known_until_it_has_recovered(
    moving: Drive, stranger: can.BusABC
) -> None:
    stranger.send(PASSIVE)
    moving.await_condition(BusCondition.ERROR_PASSIVE)
    time.sleep(0.1)
    assert moving.ticks()["bus_condition"][-1] == BusCondition.ERROR_PASSIVE
    stranger.send(RESTARTED)
    assert moving.await_active(after=newest(moving) + 5)["bus_condition"][-1] == BusCondition.OK


def test_bus_off_is_a_fault_until_the_controller_has_restarted(
    drive: Drive, stranger: can.BusABC
) -> None:
    drive.start_service()
    emulator = drive.start_emulator()
    drive.await_active()
    with emulator.stopped():  # a node off the bus hears nobody
        time.sleep(0.004)
        stranger.send(BUS_OFF)
        drive.await_condition(BusCondition.BUS_OFF)
        time.sleep(0.1)
        assert drive.ticks()["bus_condition"][-1] == BusCondition.BUS_OFF
        assert drive.ticks()["state"][-1] == TcsState.FAULT
        stranger.send(RESTARTED)
    ticks = drive.await_active(after=newest(drive))
    assert ticks["bus_condition"][-1] == BusCondition.OK


def test_errors_from_the_start_without_a_good_frame_are_reported_as_another_bit_rate(
    drive: Drive, stranger: can.BusABC
) -> None:
    service = drive.start_service()
    drive.await_ticks(lambda ticks: len(ticks) > 0, "a tick")
    for _ in range(200):  # what a controller reports that cannot read a single frame
        stranger.send(STUFF_ERROR)
    stranger.send(PASSIVE)
    ticks = drive.await_condition(BusCondition.ERROR_PASSIVE)
    assert (ticks["rx_frames"][-1], ticks["bus_errors"][-1]) == (0, 201)
    assert not ticks["failed"].any()
    service.end()
    assert "bit rate mismatch?" in service.log.read_text()


@contextmanager
def clogged_queue() -> Iterator[None]:
    """A context in which the interface takes one frame a second and refuses the others."""
    netem = ("qdisc", "replace", "dev", CHANNEL, "root", "netem", "limit", "1", "delay", "1s")
    subprocess.run(["tc", *netem], check=True)
    try:
        yield
    finally:
        subprocess.run(["tc", "qdisc", "del", "dev", CHANNEL, "root"], check=True)


def test_limits_that_cannot_be_sent_are_known_and_control_returns(moving: Drive) -> None:
    with clogged_queue():
        moving.await_condition(BusCondition.SEND_FAILED)
        time.sleep(0.2)
    ticks = moving.await_active(after=newest(moving))
    assert ticks["bus_condition"][-1] == BusCondition.OK
    assert ticks["bus_errors"][-1] > 0
    assert not ticks["failed"].any()


def test_frames_the_kernel_had_no_room_for_are_known(drive: Drive) -> None:
    service = drive.start_service()
    drive.start_emulator()
    drive.await_active()
    bus, _ = open_bus("socketcan", CHANNEL)
    port = CanPort(bus)
    with service.stopped():
        for _ in range(12_000):  # the service's buffer holds some 7000
            assert port.send(0x7AA, b"")
    port.close()
    drive.await_condition(BusCondition.OVERFLOW)
    ticks = drive.await_active(after=newest(drive))
    assert ticks["lost_frames"][-1] > 0
    assert ticks["bus_condition"][-1] == BusCondition.OK


def test_a_stranger_who_sends_limits_is_an_intruder(moving: Drive, stranger: can.BusABC) -> None:
    stranger.send(can.Message(arbitration_id=LIMIT_ID, data=bytes(8), is_extended_id=False))
    moving.await_condition(BusCondition.INTRUDER)
    ticks = moving.await_active(after=newest(moving) + 10)
    met = ticks[ticks["bus_condition"] == BusCondition.INTRUDER]
    assert len(met) == 1
    assert met["state"][0] == TcsState.FAULT


def test_its_own_frames_make_nobody_an_intruder(moving: Drive) -> None:
    moving.await_active(count=500)
    assert conditions(moving) == {BusCondition.OK}


def any_frame(chance: random.Random) -> can.Message:
    """Any frame that SocketCAN lets through, of every kind and length."""
    extended, flexible = chance.random() < 0.3, chance.random() < 0.3
    kind = chance.choice(("data", "data", "remote", "error")) if not flexible else "data"
    length = chance.choice((8, 12, 16, 20, 24, 32, 48, 64)) if flexible else chance.randrange(9)
    return can.Message(
        arbitration_id=chance.randrange(1 << (29 if extended else 11)),
        is_extended_id=extended,
        is_fd=flexible,
        is_remote_frame=kind == "remote",
        is_error_frame=kind == "error",
        dlc=length,
        data=None if kind == "remote" else chance.randbytes(length),
    )


def test_no_frame_ends_it(drive: Drive) -> None:
    service = drive.start_service()
    drive.start_emulator()
    drive.await_active()
    chance = random.Random(6)
    with can.Bus(interface="socketcan", channel=CHANNEL, fd=True) as bus:
        for _ in range(100):
            for _ in range(30):
                bus.send(any_frame(chance))
            time.sleep(0.002)
        bus.send(RESTARTED)  # some of the error frames have told of worse
    ticks = drive.await_active(after=newest(drive))
    assert service.running
    assert not ticks["failed"].any()


def test_raw_frames_that_python_can_would_not_make_do_not_end_it(drive: Drive) -> None:
    drive.start_service()
    drive.start_emulator()
    number = int(drive.await_active()["number"][-1])
    with socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW) as raw:
        raw.bind((CHANNEL,))
        for identifier in (0xFFFF_FFFF, 0x6000_0000, 0xA000_00A2, 0x0000_FFFF):
            raw.send(identifier.to_bytes(4, "little") + bytes([8, 0, 0, 0]) + b"\xff" * 8)
        raw.send(RESTARTED_BYTES)
    ticks = drive.await_active(after=number + 20)
    assert not ticks["failed"].any()


RESTARTED_BYTES = (0x2000_0100).to_bytes(4, "little") + bytes([8, 0, 0, 0]) + bytes(8)
