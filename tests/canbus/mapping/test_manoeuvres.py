"""The emulator's car on three makers' buses: slip is held as on our own."""

from __future__ import annotations

import math
from typing import NamedTuple, Protocol

import numpy as np
import pytest
from msgspec.structs import replace

from plant_emulator.recording import TruthRecorder
from plant_emulator.scenario import load_scenario
from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.hil.busless import BuslessCar
from tcs_hil.hil.metrics import SlipMetrics, slip_metrics
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.runtime.clock import MonotonicClock
from tcs_hil.service.settings import ServiceConfig
from tcs_hil.service.wiring import build_laws, build_pipeline
from tcs_hil.signals import Command, InputState, Measurement, TcsState

from .makers import MAKERS, QUENDAL, Maker
from .mapped import node_of
from .translator import Frame, Translator

LAUNCH = replace(load_scenario("manoeuvre-1").with_variant("vehicle"), duration_s=1.5)


class Road(Protocol):
    """A way from the emulator's frames to the service's pipeline and back."""

    def hear(self, frame_id: int, data: bytes, now_ns: int) -> None: ...

    def measurement(self, now_ns: int) -> Measurement: ...

    def answers(self, command: Command, now_ns: int) -> list[Frame]: ...


class OwnBus:
    """Our own DBC; ``bare`` without motors and accelerometer."""

    def __init__(self, *, bare: bool) -> None:
        self._node = TcsNode(load_database())
        self._bare = bare

    def hear(self, frame_id: int, data: bytes, now_ns: int) -> None:
        self._node.feed(frame_id, data, now_ns)

    def measurement(self, now_ns: int) -> Measurement:
        seen = self._node.measurement(now_ns)
        if not self._bare:
            return seen
        return replace(
            seen,
            motor_speed_radps=(0.0, 0.0),
            motor_torque_nm=(0.0, 0.0),
            motor_age_s=math.inf,
            motor_state=InputState.ABSENT,
            accel_x_mps2=math.nan,
        )

    def answers(self, command: Command, now_ns: int) -> list[Frame]:
        return self._node.frames(command, now_ns)


class MakersBus:
    """A maker's DBC, with a translator to and from ours."""

    def __init__(self, maker: Maker) -> None:
        self._node = node_of(maker)
        self._translator = Translator(maker)

    def hear(self, frame_id: int, data: bytes, now_ns: int) -> None:
        self._translator.hear(frame_id, data, now_ns)

    def measurement(self, now_ns: int) -> Measurement:
        for frame_id, data in self._translator.speeds_and_requests(now_ns):
            assert self._node.feed(frame_id, data, now_ns)
        return self._node.measurement(now_ns)

    def answers(self, command: Command, now_ns: int) -> list[Frame]:
        frames = self._node.frames(command, now_ns, 0)
        return [limits for frame in frames if (limits := self._translator.limits(*frame))]


class Drive(NamedTuple):
    metrics: SlipMetrics
    states: set[TcsState]


def drive(road: Road, config: ServiceConfig) -> Drive:
    """The launch, decided by the configured law on what came over ``road``."""
    pipeline = build_pipeline(config, build_laws(config, MonotonicClock()))
    recorder = TruthRecorder(None, LAUNCH, in_memory=True)
    car = BuslessCar(LAUNCH, recorder)
    states = set()
    while not car.finished:
        for frame in car.speak():
            road.hear(*frame)
        command = pipeline.step(road.measurement(car.now_ns))
        states.add(command.state)
        for frame_id, data in road.answers(command, car.now_ns):
            car.hear(frame_id, data)
        car.drive_on()
    return Drive(slip_metrics(np.array(recorder.rows), 0.1, Vehicle()), states)


@pytest.mark.parametrize("maker", MAKERS, ids=lambda maker: maker.name)
def test_slip_is_held_as_on_our_own_bus(maker: Maker) -> None:
    config = maker.config()
    found = drive(MakersBus(maker), config)
    own = drive(OwnBus(bare=maker is QUENDAL), config)
    assert found.states == {TcsState.INIT, TcsState.STANDBY, TcsState.ACTIVE}
    # Steps of 0.01 km/h and a quarter Nm, where ours are 0.003 m/s and a twentieth.
    assert found.metrics.rmse_ratio == pytest.approx(own.metrics.rmse_ratio, abs=0.001)
    assert found.metrics.peak_ratio == pytest.approx(own.metrics.peak_ratio, abs=0.005)
    assert found.metrics.final_speed_mps == pytest.approx(own.metrics.final_speed_mps, abs=0.01)
