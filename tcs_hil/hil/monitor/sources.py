"""Where the monitor looks: a bus it listens to, or a flight recording it reads."""

from __future__ import annotations

import queue
import threading
from pathlib import Path
from typing import Protocol

from tcs_hil.canbus.bench_control import AS_IN_SCENARIO, BenchControl
from tcs_hil.canbus.bench_node import BenchNode
from tcs_hil.canbus.database import Database
from tcs_hil.canbus.port import CanPort
from tcs_hil.hil.monitor.bus_view import BusView
from tcs_hil.hil.monitor.flight_view import FlightView
from tcs_hil.hil.monitor.history import Point
from tcs_hil.hil.monitor.snapshot import Snapshot
from tcs_hil.runtime.clock import MonotonicClock

POLL_S = 0.02


class Source(Protocol):
    """What the view asks ten times a second."""

    def look(self) -> tuple[Snapshot | None, list[Point]]:
        """What is known now, None before anything is, and the last seconds."""
        ...

    def ask(self, control: BenchControl, /) -> None:
        """Ask the emulator for something."""
        ...

    def close(self) -> None:
        """Stop looking."""
        ...


class BusSource:
    """Reads a bus on a thread of its own, so that no drawing keeps a sender waiting.

    Only that thread touches the port.  ``in_control`` lets `ask` send; the
    emulator is given back to its scenario at the beginning and at the end.
    """

    def __init__(
        self, port: CanPort, description: str, database: Database, *, in_control: bool
    ) -> None:
        self._port = port
        self._clock = MonotonicClock()
        self._view = BusView(database, description)
        self._node = BenchNode(database)
        self._in_control = in_control
        self._wishes: queue.SimpleQueue[BenchControl] = queue.SimpleQueue()
        self._lock = threading.Lock()
        self._closing = threading.Event()
        # An emulator that has met another monitor may take our first counter for a repetition.
        self.ask(AS_IN_SCENARIO)
        self._thread = threading.Thread(target=self._listen, name="monitor", daemon=True)
        self._thread.start()

    def look(self) -> tuple[Snapshot | None, list[Point]]:
        """What is known now, and the last seconds."""
        with self._lock:
            return self._view.snapshot(self._clock.now_ns()), list(self._view.history.points)

    def ask(self, control: BenchControl) -> None:
        """Have a control frame sent, if that was allowed; a full bus drops it."""
        if self._in_control:
            self._wishes.put(control)

    def close(self) -> None:
        """Give the emulator back and leave the bus."""
        self.ask(AS_IN_SCENARIO)
        self._closing.set()
        self._thread.join()
        self._port.close()

    def _listen(self) -> None:
        while not self._closing.is_set():
            self._send_wishes()
            if self._port.wait(POLL_S):
                frames = self._port.receive()
                with self._lock:
                    for frame in frames:
                        self._view.feed(*frame)
        self._send_wishes()

    def _send_wishes(self) -> None:
        while not self._wishes.empty():
            self._port.send(*self._node.frame(self._wishes.get()))


class FlightSource:
    """Follows a flight recording; there is nobody behind it to ask for anything."""

    def __init__(self, path: Path) -> None:
        """Open the recording.

        Raises:
            RecordingError: there is none, or it cannot be read.
        """
        self._clock = MonotonicClock()
        self._view = FlightView(path)

    def look(self) -> tuple[Snapshot | None, list[Point]]:
        """What is known now, and the last seconds."""
        snapshot = self._view.snapshot(self._clock.now_ns())
        return snapshot, list(self._view.history.points)

    def ask(self, _control: BenchControl) -> None:
        """Do nothing."""

    def close(self) -> None:
        """Nothing is held open."""
