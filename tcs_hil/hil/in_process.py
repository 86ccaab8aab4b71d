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

from plant_emulator.emulator import PERIOD_NS
from plant_emulator.recording import TruthRecorder
from plant_emulator.scenario import Scenario
from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.frame import Frame, PortCounters
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.hil.busless import BuslessCar
from tcs_hil.runtime.clock import MonotonicClock
from tcs_hil.runtime.lockstep import LockstepTrigger
from tcs_hil.runtime.loop import Loop
from tcs_hil.runtime.recorder import FlightRecorder
from tcs_hil.runtime.recording import RunInfo
from tcs_hil.service.settings import ServiceConfig
from tcs_hil.service.wiring import backend_of, build_laws, build_pipeline
from tcs_hil.signals import BusCondition

FIRST_CHANNEL = 0


class _CarPort:
    """The service's port with the car right behind it.

    Waiting for a frame lets the car speak, answering its tick lets it drive on.
    """

    def __init__(self, car: BuslessCar, log: Callable[[Frame], None]) -> None:
        self.counters = PortCounters()
        self._car = car
        self._log = log
        self._tick = 0
        self._said: list[Frame] = []

    def wait(self, _timeout_s: float) -> bool:
        """Let the car speak."""
        self._said += self._car.speak(self._tick)
        return True

    def receive(self) -> list[Frame]:
        """What the car has said."""
        said, self._said = self._said, []
        self.counters.rx += len(said)
        return said

    def send(self, frame_id: int, data: bytes) -> bool:
        """Let the car hear one frame; the last of a tick lets a period pass."""
        self.counters.tx += 1
        self._log(Frame(frame_id, data, self._car.now_ns))
        self._car.hear(frame_id, data)
        if self._car.answered(self._tick):
            self._tick += 1
            self._car.drive_on()
        return True

    def condition(self) -> BusCondition:
        """A bus that is not there has no troubles."""
        return BusCondition.OK


def drive_in_process(scenario: Scenario, config: ServiceConfig, bus: Path, truth: Path) -> None:
    """Drive ``scenario`` to its end; ``config`` says where the flight recording goes.

    Raises:
        TcsError: DBC, predictor or one of the files cannot be used.
    """
    recorder = TruthRecorder(truth, scenario)
    with ExitStack() as cleanup:
        log = _logged(cleanup.enter_context(can.Logger(str(bus))))
        flight = cleanup.enter_context(_flight_recorder(config))
        car = BuslessCar(scenario, recorder, log)
        loop = _loop(_CarPort(car, log), config, flight)
        loop.run(lambda: car.finished)
    recorder.save()


def _logged(write: Callable[[can.Message], None]) -> Callable[[Frame], None]:
    def log(frame: Frame) -> None:
        write(
            can.Message(
                timestamp=frame.stamp_ns * 1e-9,
                arbitration_id=frame.frame_id,
                data=frame.data,
                is_extended_id=False,
                channel=FIRST_CHANNEL,
            )
        )

    return log


def _loop(port: _CarPort, config: ServiceConfig, flight: FlightRecorder) -> Loop:
    database, clock = load_database(), MonotonicClock()
    node = TcsNode(database)
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
