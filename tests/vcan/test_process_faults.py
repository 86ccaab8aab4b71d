"""Either side killed, stopped, starved or moved in time, in the middle of a manoeuvre.

The driver gets his torque back at a bounded rate, never none of it, and control
returns.  In simulated time, where a machine that is busy cannot be mistaken for
the fault; `test_processes.py` has what must hold on a busy one.
"""

from __future__ import annotations

import resource
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from needs import needs

from tcs_hil.hil.metrics import Truth
from tcs_hil.signals import TcsState

from .conftest import CHANNEL
from .drive import PERIOD_S, RELEASE_NMPS, Drive, demand_nm, plant_time_s, rows_since

HOLD_S = 0.010
BUS_S = 0.006  # from a limit sent to the motor that obeys it, at most
A_ROW_NM = RELEASE_NMPS * PERIOD_S
ROUNDING_NM = 0.1


pytestmark = pytest.mark.simulated_time


@pytest.fixture
def drive(tmp_path: Path) -> Iterator[Drive]:
    drive = Drive(tmp_path, "pi")
    yield drive
    drive.clean_up()


def assert_handed_back_gently(truth: Truth, begin_s: float, end_s: float) -> None:
    """Between these moments of the plant nobody limited: held, then raised to the request."""
    silent = rows_since(truth, begin_s)
    silent = silent[silent["time_s"] <= end_s]
    steps_nm = np.diff(demand_nm(silent))
    assert len(steps_nm) > HOLD_S / PERIOD_S
    assert steps_nm.min() >= -ROUNDING_NM
    assert steps_nm.max() <= A_ROW_NM + ROUNDING_NM
    assert demand_nm(silent)[0] > 0.0


def test_a_killed_service_gives_the_torque_back_gently_and_its_successor_takes_over(
    drive: Drive,
) -> None:
    service = drive.start_service()
    drive.start_emulator()
    before = drive.await_active()
    service.kill()
    before = drive.ticks()
    time.sleep(1.0)
    drive.start_service()
    after = drive.await_active()
    truth = drive.finish()
    silent_from_s = plant_time_s(before, int(before["sent_ns"][-1])) + BUS_S
    silent_to_s = plant_time_s(before, int(after["sent_ns"][0]))
    assert silent_to_s - silent_from_s > 0.9
    assert_handed_back_gently(truth, silent_from_s, silent_to_s)
    assert demand_nm(rows_since(truth, silent_to_s))[0] == pytest.approx(250.0)
    # INIT until its inputs can be trusted, then straight into a wheel that spins.
    states = after["state"]
    assert states[0] == TcsState.INIT
    assert not np.isin(states, [TcsState.FAULT, TcsState.OFF]).any()


def test_a_killed_emulator_is_missed_at_once_and_its_successor_welcome(drive: Drive) -> None:
    service = drive.start_service()
    emulator = drive.start_emulator()
    drive.await_active()
    emulator.kill()
    alone = drive.await_ticks(lambda t: bool(t["state"][-1] == TcsState.FAULT), "a FAULT")
    drive.start_emulator()
    ticks = drive.await_active(after=int(alone["number"][-1]))
    assert service.running
    # Once in FAULT, the way back is through good frames, and no limit is left from before.
    first_fault = int(np.argmax(ticks["state"] == TcsState.FAULT))
    assert 10 * PERIOD_S < ticks["rear_speed_age_s"][first_fault] <= 12 * PERIOD_S
    assert not ticks["failed"].any()


@pytest.mark.parametrize("stop_s", [0.05, 0.5, 2.0])
def test_a_service_that_was_stopped_skips_what_it_missed_and_controls_again(
    drive: Drive, stop_s: float
) -> None:
    service = drive.start_service()
    drive.start_emulator()
    drive.await_active()
    with service.stopped():
        before = drive.ticks()
        time.sleep(stop_s)
        end_ns = time.monotonic_ns()
    number = int(before["number"][-1])
    ticks = drive.await_active(after=number + round(stop_s / PERIOD_S))
    silent_from_s = plant_time_s(before, int(before["sent_ns"][-1])) + BUS_S
    assert_handed_back_gently(drive.finish(), silent_from_s, plant_time_s(before, end_ns))
    (late,) = ticks[ticks["skipped"] > 0]
    assert late["skipped"] == pytest.approx(stop_s / PERIOD_S, abs=2)
    assert not ticks["failed"].any()


def test_an_emulator_that_was_stopped_finds_control_again(drive: Drive) -> None:
    drive.start_service()
    emulator = drive.start_emulator()
    drive.await_active()
    with emulator.stopped():
        fault = drive.await_ticks(lambda t: bool(t["state"][-1] == TcsState.FAULT), "a FAULT")
    drive.await_active(after=int(fault["number"][-1]))
    truth = drive.finish()
    assert np.all(demand_nm(rows_since(truth, 0.6)) >= 0.0)


@contextmanager
def wall_clock_moved(step_s: float) -> Iterator[None]:
    """A context in which CLOCK_REALTIME has been stepped; root's to do."""
    try:
        time.clock_settime(time.CLOCK_REALTIME, time.time() + step_s)
    except PermissionError:
        needs(None, "root, and a guest's clock to set")
    try:
        yield
    finally:
        time.clock_settime(time.CLOCK_REALTIME, time.time() - step_s)


@pytest.mark.parametrize("step_s", [-3600.0, 3600.0])
def test_a_step_of_the_wall_clock_is_not_even_noticed(drive: Drive, step_s: float) -> None:
    drive.start_service()
    drive.start_emulator()
    number = int(drive.await_active()["number"][-1])
    with wall_clock_moved(step_s):
        drive.await_active(after=number)
    ticks = drive.await_active(after=int(drive.ticks()["number"][-1]))
    since = ticks[ticks["number"] >= number]
    assert since["rear_speed_age_s"].max() <= 2 * PERIOD_S
    assert np.all(since["state"] == TcsState.ACTIVE)
    assert not since["skipped"].any()


def test_a_tick_needs_no_memory_that_it_does_not_have(drive: Drive) -> None:
    service = drive.start_service()
    drive.start_emulator()
    number = int(drive.await_active(count=200)["number"][-1])
    pages = int(Path(f"/proc/{service.pid}/statm").read_text().split()[0])
    size = pages * resource.getpagesize()
    resource.prlimit(service.pid, resource.RLIMIT_AS, (size, size))
    ticks = drive.await_active(count=50, after=number + 1000)
    assert not ticks["failed"].any()


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A file system with room for one megabyte."""
    folder = tmp_path / "small"
    folder.mkdir()
    mounted = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=1m", "small", str(folder)],
        capture_output=True,
        check=False,
    )
    needs(mounted.returncode == 0, "root, to mount a file system")
    yield folder
    subprocess.run(["umount", "--lazy", str(folder)], check=True)


def test_a_disk_without_room_for_the_flight_recording_is_refused(small_disk: Path) -> None:
    flight = small_disk / "flight"
    command = [sys.executable, "-m", "tcs_hil", "run", "--channel", CHANNEL, "--controller", "off"]
    refused = subprocess.run(
        [*command, "--flight-recording", str(flight)], capture_output=True, text=True, check=False
    )
    assert refused.returncode == 2
    assert refused.stderr.startswith(f"tcs-hil: error: {flight}: no flight recording of ")
    assert refused.stderr.endswith("(No space left on device)\n")
    assert not flight.exists()


def test_a_bus_recorder_that_dies_of_a_full_disk_disturbs_nobody(
    drive: Drive, small_disk: Path
) -> None:
    filler = small_disk / "full"
    with filler.open("wb") as file:
        file.write(bytes(900_000))
    record = ["tcs_hil", "record", str(small_disk / "bus.log"), "--channel", CHANNEL]
    recorder = subprocess.Popen(
        [sys.executable, "-m", *record], stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    with recorder:
        drive.start_service()
        drive.start_emulator()
        try:
            recorder.wait(60.0)
        finally:
            recorder.send_signal(signal.SIGKILL)
    number = int(drive.ticks()["number"][-1])
    ticks = drive.await_active(after=number)
    assert not ticks["failed"].any()
    assert not ticks["bus_errors"].any()


def test_a_second_service_on_the_channel_is_refused(drive: Drive) -> None:
    service = drive.start_service()
    drive.await_ticks(lambda t: len(t) > 0, "a tick")
    command = [sys.executable, "-m", "tcs_hil", "run", "--channel", CHANNEL, "--controller", "off"]
    refused = subprocess.run(command, capture_output=True, text=True, check=False)
    assert refused.returncode == 2
    assert refused.stderr == (
        f"tcs-hil: error: socketcan {CHANNEL} already has a traction control service "
        f"(process {service.pid})\n"
    )
    assert service.running
