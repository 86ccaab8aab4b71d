"""Plant and service in one process, through the same bytes as on a bus but without one.

For tests, tuning and campaigns: no socket, no clock, as fast as the machine goes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from plant_emulator.emulator import PERIOD_NS, Emulator
from plant_emulator.plant import Plant
from plant_emulator.recording import TruthRecorder
from plant_emulator.scenario import Scenario
from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.port import Frame
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.canbus.vehicle_node import VehicleNode
from tcs_hil.hil.metrics import Truth
from tcs_hil.runtime.clock import MonotonicClock
from tcs_hil.service.settings import ServiceConfig
from tcs_hil.service.wiring import Laws, build_laws, build_pipeline
from tcs_hil.signals import Command


@dataclass(frozen=True, slots=True)
class Simulation:
    """What a simulated run leaves: the plant's truth and every command of the service."""

    truth: Truth
    commands: tuple[Command, ...]


class _Mouth:
    """The emulator's port: what it sends is heard by the service at once."""

    def __init__(self, node: TcsNode, overhear: Callable[[Frame], None]) -> None:
        self._node = node
        self._overhear = overhear
        self.now_ns = 0

    def send(self, frame_id: int, data: bytes) -> bool:
        """Hand one frame over."""
        self._node.feed(frame_id, data, self.now_ns)
        self._overhear(Frame(frame_id, data, self.now_ns))
        return True


def nobody(_frame: Frame) -> None:
    """Listens to no frame."""


def simulate(
    scenario: Scenario,
    config: ServiceConfig,
    laws: Laws | None = None,
    overhear: Callable[[Frame], None] = nobody,
) -> Simulation:
    """Drive ``scenario`` under the service that ``config`` describes, to the scenario's end.

    The same tick order as in lockstep on a bus: speeds, decision, limits, then
    one period of driving.  ``laws`` take the place of the configured ones;
    ``overhear`` gets every frame the vehicle sends.

    Raises:
        TcsError: the DBC or the predictor cannot be used.
    """
    database = load_database()
    node = TcsNode(database)
    mouth = _Mouth(node, overhear)
    recorder = TruthRecorder(None, scenario, in_memory=True)
    emulator = Emulator(Plant(scenario), VehicleNode(database), mouth, recorder)
    pipeline = build_pipeline(config, laws or build_laws(config, MonotonicClock()))
    commands = []
    while not emulator.plant.finished:
        emulator.publish()
        command = pipeline.step(node.measurement(mouth.now_ns))
        for frame_id, data in node.frames(command, mouth.now_ns):
            emulator.hear(frame_id, data, mouth.now_ns)
        commands.append(command)
        mouth.now_ns += PERIOD_NS
        emulator.advance_to(mouth.now_ns)
    return Simulation(np.array(recorder.rows), tuple(commands))
