"""The daemon as a process among strangers on the embedded bus."""

import json
import os
import re
import signal
import subprocess
import sys
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import can
import numpy as np
import pytest

from tcs_hil.canbus.bus import open_bus
from tcs_hil.hil.processes.program import Program, program
from tcs_hil.runtime.recording import read
from tcs_hil.signals import TcsState

LIMIT_ID = 0x090
NO_LIMIT_BITS = 0x3FFF
HALF_A_PERIOD_NS = 1_000_000
PATIENCE_S = 60.0  # for a daemon to start on a crowded machine


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
        message = bus.recv(timeout=PATIENCE_S)
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
    with subprocess.Popen(
        [
            *(sys.executable, "-m", "tcs_hil", "run", "--interface", "embedded"),
            *("--channel", channel, "--controller", "off"),
            *("--flight-recording", str(flight), "--json"),
        ],
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONUNBUFFERED": "1"},
    ) as child:
        try:
            limits(stranger, 10)
            child.send_signal(number)
            output, _ = child.communicate(timeout=PATIENCE_S)
        finally:
            child.kill()  # a daemon that outlives a failed test disturbs all that come after it
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
    assert "controller: pi (python)" in log.read_text()


def test_a_service_that_ticks_with_a_frame_gives_a_missing_one_half_a_period(
    channel: str, tmp_path: Path, stranger: can.BusABC
) -> None:
    flight = tmp_path / "flight.tcsrec"
    options = ("--trigger", "frame", "--controller", "off", "--flight-recording", str(flight))
    with daemon(channel, tmp_path, *options):
        limits(stranger, 10)
    ticks = read(flight)
    # The median: on a crowded machine some tick may be later still, and give its turn away.
    assert np.median(ticks["wake_ns"] - ticks["scheduled_ns"]) >= HALF_A_PERIOD_NS


def test_its_recording_is_reported_while_it_runs(
    channel: str, tmp_path: Path, stranger: can.BusABC
) -> None:
    flight = tmp_path / "flight.tcsrec"
    report = [sys.executable, "-m", "tcs_hil", "report", str(flight), "--worst", "1", "--json"]
    with daemon(channel, tmp_path, "--controller", "off", "--flight-recording", str(flight)):
        counts = []
        for _ in range(2):
            limits(stranger, 20)
            output = subprocess.run(report, capture_output=True, text=True, check=True).stdout
            counts.append(json.loads(output)["ticks"])
        limits(stranger, 1)
    assert 20 <= counts[0] < counts[1] < len(read(flight))


def test_a_second_daemon_on_the_channel_is_refused_and_the_first_named(
    channel: str, tmp_path: Path, stranger: can.BusABC
) -> None:
    rival = [sys.executable, "-m", "tcs_hil", "run", "--interface", "embedded"]
    with daemon(channel, tmp_path, "--controller", "off"):
        refused = subprocess.run(
            [*rival, "--channel", channel, "--controller", "off"],
            capture_output=True,
            text=True,
            check=False,
        )
        assert refused.returncode == 2
        assert re.fullmatch(
            f"tcs-hil: error: embedded {channel} already has a traction control service "
            r"\(process \d+\)\n",
            refused.stderr,
        )
        limits(stranger, 10)
