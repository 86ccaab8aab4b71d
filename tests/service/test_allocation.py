"""The tick of the whole service leaves nothing behind: the collector is off while it runs."""

from __future__ import annotations

import gc
import tracemalloc
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from runtime.fakes import PERIOD_NS, RUN, FakeClock

from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.port import Frame, PortCounters
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.canbus.vehicle_node import VehicleNode, VehicleSignals
from tcs_hil.runtime.loop import Loop
from tcs_hil.runtime.recorder import FlightRecorder
from tcs_hil.runtime.trigger import TimerTrigger
from tcs_hil.service.settings import ServiceConfig
from tcs_hil.service.wiring import build_laws, build_pipeline
from tcs_hil.signals import BusCondition

FREE_LIST = 2200  # CPython keeps up to 2000 discarded tuples of each length for reuse
SPINNING = VehicleSignals(
    wheel_speed_radps=(14.0, 14.0, 11.0, 11.0),
    wheel_speed_valid=(True, True, True, True),
    motor_speed_radps=(42.0, 42.0),
    motor_torque_nm=(150.0, 150.0),
    driver_torque_nm=(200.0, 200.0),
)


class VehiclePort:
    """A bus with a vehicle that says the same thing for ever, in fresh frames."""

    def __init__(self, clock: FakeClock) -> None:
        self.counters = PortCounters()
        self._clock = clock
        self._vehicle = VehicleNode(load_database())

    def receive(self) -> list[Frame]:
        now_ns = self._clock.now_ns()
        frames = self._vehicle.frames(SPINNING, now_ns)
        return [Frame(frame_id, data, now_ns) for frame_id, data in frames]

    def send(self, frame_id: int, data: bytes) -> bool:
        return True

    def wait(self, timeout_s: float) -> bool:
        return True

    def condition(self) -> BusCondition:
        return BusCondition.OK


@pytest.fixture
def make_loop(tmp_path: Path) -> Iterator[Callable[[str], Loop]]:
    with FlightRecorder(tmp_path / "flight", RUN, 100) as recorder:
        yield lambda controller: wired(controller, recorder)


def wired(controller: str, recorder: FlightRecorder) -> Loop:
    config = ServiceConfig(controller=controller)
    clock = FakeClock()
    port = VehiclePort(clock)
    laws = build_laws(config, clock)
    return Loop(
        TimerTrigger(clock, port, PERIOD_NS),
        port,
        TcsNode(load_database()),
        build_pipeline(config, laws),
        laws,
        clock,
        recorder.write,
        lambda _: None,
    )


def run(loop: Loop, ticks: int) -> None:
    left = iter(range(ticks))
    loop.run(lambda: next(left, None) is None)


@pytest.fixture
def collector_off() -> Iterator[None]:
    gc.collect()
    gc.disable()
    yield
    gc.enable()


@pytest.mark.usefixtures("collector_off")
@pytest.mark.parametrize("controller", ["pi", "kmpc", "nmpc"])
def test_a_thousand_ticks_leave_no_object_behind(
    make_loop: Callable[[str], Loop], controller: str
) -> None:
    loop = make_loop(controller)
    run(loop, 200)
    before = len(gc.get_objects())
    run(loop, 1000)
    assert loop.failures == 0
    assert len(gc.get_objects()) - before < 100  # one per tick would be a thousand


@pytest.mark.usefixtures("collector_off")
def test_a_thousand_ticks_leave_no_memory_behind(make_loop: Callable[[str], Loop]) -> None:
    loop = make_loop("pi")
    tracemalloc.start()
    try:
        run(loop, FREE_LIST)
        before, _ = tracemalloc.get_traced_memory()
        run(loop, 1000)
        after, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert after - before < 1000  # less than a byte per tick
