"""Two live buses joined: the emulator in lockstep on one, a service on a maker's DBC on another."""

from __future__ import annotations

import select
from collections.abc import Iterator
from pathlib import Path

import can

from tcs_hil.hil.processes.program import Program, program

from .makers import Maker
from .translator import Frame, Translator

TICK_ID, DONE_ID = 0x7F0, 0x7F1
PERIOD_NS = 2_000_000
GIVE_UP_S = 20.0

SCENARIO = """
description = "a launch on ice, cut short"
duration_s = 0.4
start_speed_kmph = 5.0
road = [{ mu = 0.15 }]

[driver]
request = [[0.0, 0.0], [0.1, 250.0]]
"""


class Bridge:
    """Passes on, translated and in order, what each side says; ``limits`` are those that came."""

    def __init__(self, emulators: can.BusABC, services: can.BusABC, maker: Maker) -> None:
        self._emulators = emulators
        self._services = services
        self._translator = Translator(maker)
        self.ticks = 0
        self.limited = 0

    def run(self, emulator: Program) -> None:
        """Until the emulator has come to the end of its scenario."""
        while emulator.running:
            readable, _, _ = select.select([self._emulators, self._services], [], [], 0.1)
            for bus in readable:
                for message in _waiting(bus):
                    if bus is self._emulators:
                        self._from_emulator(message.arbitration_id, bytes(message.data))
                    else:
                        self._from_service(message.arbitration_id, bytes(message.data))

    def _from_emulator(self, frame_id: int, data: bytes) -> None:
        now_ns = self.ticks * PERIOD_NS
        if frame_id != TICK_ID:
            self._translator.hear(frame_id, data, now_ns)
            return
        for frame in self._translator.speeds_and_requests(now_ns):
            _send(self._services, frame)
        _send(self._services, (frame_id, data))
        self.ticks += 1

    def _from_service(self, frame_id: int, data: bytes) -> None:
        if frame_id == DONE_ID:
            _send(self._emulators, (frame_id, data))
            return
        limits = self._translator.limits(frame_id, data)
        assert limits is not None, f"the service sent {frame_id:#x}"
        _send(self._emulators, limits)


def drive(
    maker: Maker,
    emulators: can.BusABC,
    services: can.BusABC,
    folder: Path,
    channels: tuple[str, str],
) -> tuple[int, Path, Path]:
    """Run emulator and service as processes; ticks bridged, the truth and the flight recording."""
    scenario = folder / "ice.toml"
    scenario.write_text(SCENARIO)
    truth, flight = folder / "truth.npz", folder / "flight.tcsrec"
    bridge = Bridge(emulators, services, maker)
    service = ("tcs_hil", "run", "--config", str(maker.toml), "--trigger", "lockstep")
    plant = ("plant_emulator", "run", "--scenario", str(scenario), "--mode", "lockstep")
    with (
        program(
            *service,
            *("--channel", channels[1], "--flight-recording", str(flight)),
            log=folder / "service.log",
        ),
        program(
            *plant,
            *("--interface", "embedded", "--channel", channels[0], "--record", str(truth)),
            log=folder / "plant.log",
        ) as emulator,
    ):
        bridge.run(emulator)
    return bridge.ticks, truth, flight


def _waiting(bus: can.BusABC) -> Iterator[can.Message]:
    while (message := bus.recv(timeout=0.0)) is not None:
        yield message


def _send(bus: can.BusABC, frame: Frame) -> None:
    frame_id, data = frame
    bus.send(
        can.Message(arbitration_id=frame_id, data=data, is_extended_id=False), timeout=GIVE_UP_S
    )
