"""A manoeuvre between service and emulator, as processes that may be hit by anything.

Started as their users start them.  Positions in a drive are found in the
service's flight recording: what a test waits for is a tick, never a time.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tcs_hil.hil.metrics import Truth
from tcs_hil.runtime.recording import RecordingError, read
from tcs_hil.signals import BusCondition, TcsState

from .conftest import CHANNEL

PATIENCE_S = 10.0  # of simulated time
POLL_S = 0.05  # a recording has to be looked at: its writer, in the tick, tells nobody
PERIOD_S = 0.002
RELEASE_NMPS = 500.0
SNOW = """
description = "Full throttle on snow until somebody says stop"
duration_s = 90.0
start_speed_kmph = 10.0
[vehicle]
variant = "vehicle"
[[road]]
mu = 0.15
[driver]
request = [[0.1, 0.0], [0.6, 250.0]]
"""

Ticks = NDArray[np.void]


class Process:
    """One of the two programs, with its log."""

    def __init__(self, *arguments: str, log: Path) -> None:
        self.log = log
        self.killed = False
        with log.open("ab") as output:
            self._child = subprocess.Popen(
                [sys.executable, "-m", *arguments], stdout=output, stderr=output
            )

    @property
    def pid(self) -> int:
        return self._child.pid

    @property
    def running(self) -> bool:
        return self._child.poll() is None

    def send(self, number: signal.Signals) -> None:
        os.kill(self.pid, number)

    def kill(self) -> None:
        self.killed = True
        self._child.kill()
        self._child.wait()

    def end(self) -> None:
        self.send(signal.SIGTERM)
        self._child.wait(PATIENCE_S)

    @contextmanager
    def stopped(self) -> Iterator[None]:
        """A context without it: as if nobody scheduled it."""
        self.send(signal.SIGSTOP)
        try:
            yield
        finally:
            self.send(signal.SIGCONT)


class Drive:
    """Service and emulator on vcan0; both can be started again."""

    def __init__(self, folder: Path, controller: str) -> None:
        self.flight, self.truth = folder / "flight", folder / "truth.npz"
        self._folder = folder
        self._controller = controller
        self._started: list[Process] = []
        (folder / "snow.toml").write_text(SNOW)
        (folder / "service.toml").write_text("[recorder]\nticks = 100_000\n[tick]\nphase_us = 500")

    def start_service(self) -> Process:
        self.flight.unlink(missing_ok=True)  # what is read from now on is the new service's
        return self._start(
            *("tcs_hil", "run", "--config", str(self._folder / "service.toml")),
            *("--controller", self._controller, "--flight-recording", str(self.flight)),
        )

    def start_emulator(self) -> Process:
        scenario = str(self._folder / "snow.toml")
        return self._start(
            *("plant_emulator", "run", "--scenario", scenario, "--record", str(self.truth))
        )

    def ticks(self) -> Ticks:
        """What the present service has recorded so far; none before its first tick."""
        try:
            return read(self.flight)
        except RecordingError:
            return np.zeros(0, [("state", "u1")])

    def await_ticks(self, enough: Callable[[Ticks], bool], what: str) -> Ticks:
        deadline_s = time.monotonic() + PATIENCE_S
        while not enough(ticks := self.ticks()):
            assert all(process.running or process.killed for process in self._started), self._logs()
            assert time.monotonic() < deadline_s, f"{what} did not come\n{self._logs()}"
            time.sleep(POLL_S)
        return ticks

    def await_active(self, count: int = 50, after: int = -1) -> Ticks:
        """Return once the newest ``count`` ticks, all later than number ``after``, were ACTIVE."""

        def enough(ticks: Ticks) -> bool:
            newest = ticks[-count:]
            return (
                len(newest) == count
                and newest["number"][0] > after
                and bool(np.all(newest["state"] == TcsState.ACTIVE))
            )

        return self.await_ticks(enough, "an ACTIVE service")

    def await_condition(self, condition: BusCondition) -> Ticks:
        return self.await_ticks(
            lambda ticks: len(ticks) > 0 and condition in ticks["bus_condition"], condition.name
        )

    def finish(self) -> Truth:
        """Stop both and return the newest emulator's truth."""
        for process in self._started:
            if process.running:
                process.end()
        with np.load(self.truth) as recording:
            rows: Truth = recording["truth"]
        return rows

    def clean_up(self) -> None:
        for process in self._started:
            if process.running:
                process.send(signal.SIGCONT)
                process.kill()

    def _logs(self) -> str:
        return "\n".join(process.log.read_text() for process in self._started)

    def _start(self, *arguments: str) -> Process:
        log = self._folder / f"{arguments[0]}.log"
        process = Process(*arguments, "--channel", CHANNEL, log=log)
        self._started.append(process)
        return process


def demand_nm(truth: Truth) -> NDArray[np.float64]:
    """What the left motor was asked for: (n,)."""
    demand: NDArray[np.float64] = np.minimum(truth["request_nm"], truth["limit_nm"][:, 0])
    return demand


def rows_since(truth: Truth, seconds: float) -> Truth:
    """The rows from a moment of the plant's own time on."""
    return truth[truth["time_s"] >= seconds]


def plant_time_s(ticks: Ticks, monotonic_ns: int) -> float:
    """The plant's time at a moment of the machine's clock, by the driver's ramp of 500 Nm/s."""
    ramp = ticks[(ticks["driver_torque_fl_nm"] > 10.0) & (ticks["driver_torque_fl_nm"] < 240.0)]
    since_s = 0.1 + ramp["driver_torque_fl_nm"] / 500.0
    start_ns = ramp["now_ns"] - (ramp["driver_age_s"] + since_s) * 1e9
    return float(monotonic_ns - np.median(start_ns)) * 1e-9
