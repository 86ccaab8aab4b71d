"""Plant and service in one process, through the same bytes as on a bus but without one.

For tests, tuning and campaigns: no socket, no clock, as fast as the machine goes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from plant_emulator.recording import TruthRecorder
from plant_emulator.scenario import Scenario
from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.frame import Frame
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.hil.busless import BuslessCar, nobody
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
    node = TcsNode(load_database())
    recorder = TruthRecorder(None, scenario, in_memory=True)
    car = BuslessCar(scenario, recorder, overhear)
    pipeline = build_pipeline(config, laws or build_laws(config, MonotonicClock()))
    commands = []
    while not car.finished:
        for frame in car.speak():
            node.feed(frame.frame_id, frame.data, frame.stamp_ns)
        command = pipeline.step(node.measurement(car.now_ns))
        for frame_id, data in node.frames(command, car.now_ns):
            car.hear(frame_id, data)
        commands.append(command)
        car.drive_on()
    return Simulation(recorder.rows, tuple(commands))
