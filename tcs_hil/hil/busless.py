"""The emulator with no bus between it and whoever listens: for runs in one process."""

from __future__ import annotations

from collections.abc import Callable

from plant_emulator.emulator import PERIOD_NS, Emulator
from plant_emulator.plant import Plant
from plant_emulator.recording import TruthRecorder
from plant_emulator.scenario import Scenario
from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.frame import Frame
from tcs_hil.canbus.vehicle_node import VehicleNode


def nobody(_frame: Frame) -> None:
    """Listens to no frame."""


class BuslessCar:
    """Speaks, hears and drives on when it is told to, as in lockstep on a bus.

    ``now_ns`` is the time it has come to and the stamp of what it says, which
    ``overhear`` gets as it is said.
    """

    def __init__(
        self,
        scenario: Scenario,
        recorder: TruthRecorder,
        overhear: Callable[[Frame], None] = nobody,
    ) -> None:
        self.now_ns = 0
        self._overhear = overhear
        self._said: list[Frame] = []
        self._emulator = Emulator(Plant(scenario), VehicleNode(load_database()), self, recorder)

    @property
    def finished(self) -> bool:
        """Whether it has come to the end of its scenario."""
        return self._emulator.plant.finished

    def speak(self, tick: int | None = None) -> list[Frame]:
        """What it says at this instant; with ``tick``, also that this was all of that tick."""
        self._emulator.publish()
        if tick is not None:
            self._emulator.send_tick(tick)
        said, self._said = self._said, []
        return said

    def send(self, frame_id: int, data: bytes) -> bool:
        """Keep one of its frames until it speaks: one that was delayed comes while it drives."""
        frame = Frame(frame_id, data, self.now_ns)
        self._said.append(frame)
        self._overhear(frame)
        return True

    def hear(self, frame_id: int, data: bytes) -> None:
        """Take one frame of the service."""
        self._emulator.hear(frame_id, data, self.now_ns)

    def answered(self, tick: int) -> bool:
        """Whether the service has said that it sent all its answers to this tick."""
        return self._emulator.answered(tick)

    def drive_on(self) -> None:
        """Let one period pass."""
        self.now_ns += PERIOD_NS
        self._emulator.advance_to(self.now_ns)
