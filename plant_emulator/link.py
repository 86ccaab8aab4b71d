"""Everything between a node and the far end of the wire: faults on frames, jitter, the bus."""

from __future__ import annotations

import numpy as np

from plant_emulator.faults import Fault
from plant_emulator.frame_faults import FrameFaults, TimedFrame
from plant_emulator.scenario import Scenario
from plant_emulator.virtual_bus import Delivery, Sender, VirtualBus
from tcs_hil.canbus.database import Database


class Link:
    """Frames of both nodes in, frames that arrive out.  Pure: times are arguments, in ns."""

    def __init__(self, scenario: Scenario, database: Database) -> None:
        timing = scenario.bus_timing
        self._rng = np.random.default_rng([timing.seed, 2])
        self._jitter_ns = timing.jitter_s * 1e9
        self._database = database
        self._scenario_faults = self._layers_of(scenario.fault)
        self._layers = self._scenario_faults
        self._bus = VirtualBus(timing)
        self._babbled_ns = 0

    def inject(self, faults: tuple[Fault, ...]) -> None:
        """Let ``faults`` act on what the scenario's leave, instead of those injected before."""
        self._layers = self._scenario_faults + self._layers_of(faults)

    def offer(self, time_ns: int, frame_id: int, data: bytes, sender: Sender) -> None:
        """Let ``sender`` queue a frame, unless a fault has it otherwise."""
        if sender is Sender.VEHICLE and self._jitter_ns:
            time_ns += int(self._rng.uniform(0.0, self._jitter_ns))
        if not self._layers:  # the usual case: frames take the short way
            self._bus.offer(time_ns, frame_id, data, sender)
            return
        frames = [TimedFrame(time_ns, frame_id, data)]
        for layer in self._layers:
            frames = [after for before in frames for after in layer.pass_on(before, sender)]
        for frame in frames:
            self._bus.offer(frame.time_ns, frame.frame_id, frame.data, sender, frame.mailbox)

    def run_until(self, now_ns: int) -> list[Delivery]:
        """Carry the bus on to ``now_ns``; returns the frames that arrive, in order."""
        for layer in self._layers:
            for frame in layer.babble(self._babbled_ns, now_ns):
                self._bus.offer(frame.time_ns, frame.frame_id, frame.data, Sender.VEHICLE)
        self._babbled_ns = max(now_ns, self._babbled_ns)
        arrived = self._bus.run_until(now_ns)
        if not self._layers:
            return arrived
        return [
            delivery
            for delivery in arrived
            if delivery.frame.sender is Sender.VEHICLE or not self._deaf(delivery.time_ns * 1e-9)
        ]

    def _deaf(self, time_s: float) -> bool:
        return any(layer.deaf(time_s) for layer in self._layers)

    def _layers_of(self, faults: tuple[Fault, ...]) -> list[FrameFaults]:
        return [FrameFaults(faults, self._database, self._rng)] if faults else []

    @property
    def next_arrival_ns(self) -> int | None:
        """When the frame on the wire ends, None if there is none."""
        return self._bus.next_arrival_ns
