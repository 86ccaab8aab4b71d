"""The daemon as a process among strangers on the embedded bus."""

import json
import os
import signal
import subprocess
import sys
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import can
import pytest

from tcs_hil.canbus.bus import open_bus
from tcs_hil.hil.processes import Program, program
from tcs_hil.runtime.recording import read
from tcs_hil.signals import TcsState

LIMIT_ID = 0x090
NO_LIMIT_BITS = 0x3FFF


@pytest.fixture
def channel() -> str:
    return f"vcan-{uuid.uuid4().hex[:8]}"


@pytest.fixture
def stranger(channel: str) -> Iterator[can.BusABC]:
    bus, _ = open_bus("embedded", channel)
    with bus:
        yield bus


@contextmanager
def daemon(channel: str, tmp_path: Path, *options: str) -> Iterator[Program]:
    arguments = ("tcs_hil", "run", "--interface", "embedded", "--channel", channel, *options)
    with program(*arguments, log=tmp_path / "service.log") as child:
        yield child


def limits(bus: can.BusABC, count: int) -> list[can.Message]:
    """The next ``count`` torque-limit frames; the daemon sends one every 2 ms."""
    found: list[can.Message] = []
    while len(found) < count:
        message = bus.recv(timeout=5.0)
        assert message is not None, "the daemon is silent"
        if message.arbitration_id == LIMIT_ID:
            found.append(message)
    return found


def test_alone_on_the_bus_it_limits_nothing(
    channel: str, tmp_path: Path, stranger: can.BusABC
) -> None:
    with daemon(channel, tmp_path, "--controller", "off"):
        for message in limits(stranger, 20):
            bits = int.from_bytes(message.data, "little")
            assert bits >> 16 & NO_LIMIT_BITS == bits >> 30 & NO_LIMIT_BITS == NO_LIMIT_BITS
            assert bits >> 44 & 0b111 == TcsState.INIT


def test_garbage_on_the_bus_is_survived(channel: str, tmp_path: Path, stranger: can.BusABC) -> None:
    garbage = [
        can.Message(arbitration_id=0x0A2, data=bytes(8), is_extended_id=False),  # wrong CRC
        can.Message(arbitration_id=0x0A2, data=bytes(3), is_extended_id=False),  # wrong length
        can.Message(arbitration_id=0x7AA, data=b"strange", is_extended_id=False),
        can.Message(arbitration_id=0x0A2, data=bytes(8), is_extended_id=True),
        can.Message(arbitration_id=0x0A2, is_remote_frame=True, dlc=8, is_extended_id=False),
        can.Message(arbitration_id=0x0A2, is_error_frame=True, dlc=8),
        can.Message(arbitration_id=0x090, data=bytes(6), is_extended_id=False),  # its own id
    ]
    with daemon(channel, tmp_path, "--controller", "pi") as child:
        for message in garbage * 20:
            stranger.send(message)
        limits(stranger, 50)
        assert child.running


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_it_cleanly_with_a_summary(
    channel: str, tmp_path: Path, stranger: can.BusABC, number: signal.Signals
) -> None:
    flight = tmp_path / "flight.tcsrec"
    child = subprocess.Popen(
        [
            *(sys.executable, "-m", "tcs_hil", "run", "--interface", "embedded"),
            *("--channel", channel, "--controller", "off"),
            *("--flight-recording", str(flight), "--json"),
        ],
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONUNBUFFERED": "1"},
    )
    limits(stranger, 10)
    child.send_signal(number)
    output, _ = child.communicate(timeout=20.0)
    assert child.returncode == 0
    summary = json.loads(output.splitlines()[-1])
    assert summary["ticks"] >= 10
    assert summary["wake_jitter"]["p99_us"] >= summary["wake_jitter"]["p50_us"]
    assert len(read(flight)) == summary["ticks"]


def test_the_configuration_file_is_obeyed_and_options_win(
    channel: str, tmp_path: Path, stranger: can.BusABC
) -> None:
    config = tmp_path / "service.toml"
    config.write_text(f"controller = 'nmpc'\n[bus]\ninterface = 'embedded'\nchannel = '{channel}'")
    log = tmp_path / "service.log"
    with program("tcs_hil", "run", "--config", str(config), "--controller", "pi", log=log):
        limits(stranger, 1)
    assert "controller: pi" in log.read_text()
