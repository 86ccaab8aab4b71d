"""A scenario to start from, and a service with one idea for the plant to talk to."""

import threading
from pathlib import Path

import msgspec
import pytest
from factories import command

from plant_emulator.plant import Plant
from plant_emulator.scenario import Scenario, load_scenario
from tcs_hil.canbus.bus import open_bus
from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.port import CanPort
from tcs_hil.canbus.tcs_node import TcsNode


class ScriptedService:
    """Answers every bench tick with the same torque limit and remembers what it was sent."""

    def __init__(self, channel: str, limit_nm: float) -> None:
        self.received = []
        self.measurements = []
        self._limit_nm = limit_nm
        self._node = TcsNode(load_database())
        self._port = CanPort(open_bus("embedded", channel)[0], send_timeout_s=1.0)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._serve)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._stop.set()
        self._thread.join()
        self._port.close()

    def _serve(self):
        while not self._stop.is_set():
            self._port.wait(0.02)
            for frame in self._port.receive():
                self.received.append((frame.frame_id, frame.data))
                before = self._node.bench_tick
                self._node.feed(*frame)
                if self._node.bench_tick != before:
                    self._answer(self._node.bench_tick)

    def _answer(self, tick):
        now_ns = tick * 2_000_000
        self.measurements.append(self._node.measurement(now_ns))
        for frame in self._node.frames(command(self._limit_nm, self._limit_nm), now_ns):
            self._port.send(*frame)
        self._port.send(*self._node.bench_tick_done(tick))


@pytest.fixture
def drive():
    """Make a plant of whole-car parameters: ``drive(request, tyre={...}, sensors={...}, ...)``."""

    def make(request=((0.0, 0.0),), **tables):
        document = {"description": "test", "duration_s": 60.0, "driver": {"request": request}}
        document["vehicle"] = {
            name: tables.pop(name)
            for name in ("variant", "body", "tyre", "driveline")
            if name in tables
        }
        return Plant(msgspec.convert(document | tables, Scenario))

    return make


@pytest.fixture
def service():
    """Make a scripted service on a channel: ``service(channel, limit_nm)``."""
    return ScriptedService


@pytest.fixture
def command_frame():
    """Make the frame that carries a torque limit: ``command_frame(limit_nm)``."""
    node = TcsNode(load_database())
    return lambda limit_nm: node.frames(command(limit_nm, limit_nm), 0)[-1]


@pytest.fixture
def launch() -> Scenario:
    """The paper's first manoeuvre, cut to a tenth of a second of full throttle."""
    scenario = load_scenario("manoeuvre-1")
    driver = msgspec.structs.replace(scenario.driver, request=((0.0, 250.0),))
    return msgspec.structs.replace(scenario, driver=driver, duration_s=0.1)


@pytest.fixture
def channel(tmp_path: Path) -> str:
    """An embedded channel nobody else is on."""
    return f"vcan-{tmp_path.name}"[:40]
