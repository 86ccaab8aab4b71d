"""The emulator as a process: it says when it is ready and stops when it is told to."""

import os
import signal
import socket
import subprocess
import sys

import numpy as np
import pytest

ENDLESS = """
description = "an hour at walking pace"
duration_s = 3600.0
start_speed_kmph = 5.0
[driver]
request = [[0.0, 5.0]]
"""


@pytest.fixture
def emulator(tmp_path, channel):
    """A running emulator that has reported READY=1."""
    scenario, address = tmp_path / "endless.toml", str(tmp_path / "notify")
    scenario.write_text(ENDLESS)
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as listener:
        listener.bind(address)
        listener.settimeout(60.0)
        process = subprocess.Popen(
            [
                *(sys.executable, "-m", "plant_emulator", "run", "--scenario", str(scenario)),
                *("--interface", "embedded", "--channel", channel),
                *("--record", str(tmp_path / "truth.npz")),
            ],
            env=os.environ | {"NOTIFY_SOCKET": address},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        assert listener.recv(64) == b"READY=1"
        yield process
        process.kill()
        process.communicate()


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_the_run_cleanly_and_the_truth_is_kept(emulator, tmp_path, number):
    emulator.send_signal(number)
    out, err = emulator.communicate(timeout=30.0)
    assert emulator.returncode == 0, err
    assert "wake jitter" in out
    with np.load(tmp_path / "truth.npz") as file:
        assert file["truth"]["speed_mps"][:1] == pytest.approx(5 / 3.6)
        assert file["truth"].size == file["jitter_ns"].size
