"""Service and plant in one process, through the service's own loop and recorders.

The same frames, ticks and truth as in lockstep on a bus, several times faster;
what is missing is the bus.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

import can

from plant_emulator.emulator import PERIOD_NS, Emulator
from plant_emulator.plant import Plant
from plant_emulator.recording import TruthRecorder
from plant_emulator.scenario import Scenario
from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.port import Frame, PortCounters
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.canbus.vehicle_node import VehicleNode
from tcs_hil.runtime.clock import MonotonicClock
from tcs_hil.runtime.lockstep import LockstepTrigger
from tcs_hil.runtime.loop import Loop
from tcs_hil.runtime.recorder import FlightRecorder
from tcs_hil.runtime.recording import RunInfo
from tcs_hil.service.settings import ServiceConfig
from tcs_hil.service.wiring import backend_of, build_laws, build_pipeline
from tcs_hil.signals import BusCondition

FIRST_CHANNEL = 0


class _Mouth:
    """Where the emulator's frames go: to the service's ear, and on record."""

    def __init__(self, log: Callable[[can.Message], None]) -> None:
        self._log = log
        self.now_ns = 0
        self.said: list[Frame] = []

    def send(self, frame_id: int, data: bytes) -> bool:
        """Take one frame of the vehicle."""
        self.record(frame_id, data)
        self.said.append(Frame(frame_id, data, self.now_ns))
        return True

    def record(self, frame_id: int, data: bytes) -> None:
        """Log one frame, whoever sent it."""
        self._log(
            can.Message(
                timestamp=self.now_ns * 1e-9,
                arbitration_id=frame_id,
                data=data,
                is_extended_id=False,
                channel=FIRST_CHANNEL,
            )
        )


class _PlantPort:
    """The service's port with the plant right behind it.

    Waiting for a frame lets the plant speak, answering its tick lets it drive on.
    """

    def __init__(self, emulator: Emulator, mouth: _Mouth) -> None:
        self.counters = PortCounters()
        self._emulator = emulator
        self._mouth = mouth
        self._tick = 0

    def wait(self, _timeout_s: float) -> bool:
        """Let the plant speak."""
        self._emulator.publish()
        self._emulator.send_tick(self._tick)
        return True

    def receive(self) -> list[Frame]:
        """What the plant has said."""
        said, self._mouth.said = self._mouth.said, []
        self.counters.rx += len(said)
        return said

    def send(self, frame_id: int, data: bytes) -> bool:
        """Let the plant hear one frame; the last of a tick lets a period pass."""
        self.counters.tx += 1
        self._mouth.record(frame_id, data)
        self._emulator.hear(frame_id, data, self._mouth.now_ns)
        if self._emulator.answered(self._tick):
            self._tick += 1
            self._mouth.now_ns += PERIOD_NS
            self._emulator.advance_to(self._mouth.now_ns)
        return True

    def condition(self) -> BusCondition:
        """A bus that is not there has no troubles."""
        return BusCondition.OK


def drive_in_process(scenario: Scenario, config: ServiceConfig, bus: Path, truth: Path) -> None:
    """Drive ``scenario`` to its end; ``config`` says where the flight recording goes.

    Raises:
        TcsError: DBC, predictor or one of the files cannot be used.
    """
    plant = Plant(scenario)
    recorder = TruthRecorder(truth, scenario)
    with ExitStack() as cleanup:
        log = cleanup.enter_context(can.Logger(str(bus)))
        flight = cleanup.enter_context(_flight_recorder(config))
        loop = _loop(plant, config, recorder, flight, log)
        loop.run(lambda: plant.finished)
    recorder.save()


def _loop(
    plant: Plant,
    config: ServiceConfig,
    recorder: TruthRecorder,
    flight: FlightRecorder,
    log: Callable[[can.Message], None],
) -> Loop:
    database, clock = load_database(), MonotonicClock()
    node, mouth = TcsNode(database), _Mouth(log)
    port = _PlantPort(Emulator(plant, VehicleNode(database), mouth, recorder), mouth)
    tick_id = database.messages["BenchTick"].frame_id
    laws = build_laws(config, clock)
    return Loop(
        trigger=LockstepTrigger(clock, port, node, tick_id, PERIOD_NS),
        port=port,
        node=node,
        pipeline=build_pipeline(config, laws),
        laws=laws,
        clock=clock,
        write=flight.write,
        healthy=_unwatched,
    )


def _unwatched(_sent_ns: int) -> None:
    """No watchdog guards a run that nobody's torque depends on."""


def _flight_recorder(config: ServiceConfig) -> FlightRecorder:
    info = RunInfo(
        period_ns=PERIOD_NS,
        started_monotonic_ns=0,  # the bench's clock
        started_realtime_ns=time.time_ns(),
        controller=config.controller,
        backend=backend_of(config),
        bus="in process",
        machine="in process",
    )
    return FlightRecorder(Path(str(config.recorder.path)), info, config.recorder.ticks)
