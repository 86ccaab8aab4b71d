"""Everything between a node and the far end of the wire: faults on frames, jitter, the bus."""

from __future__ import annotations

import numpy as np

from plant_emulator.bustiming import Delivery, Sender, VirtualBus
from plant_emulator.frame_faults import FrameFaults, TimedFrame
from plant_emulator.scenario import Scenario
from tcs_hil.canbus.database import Database


class Link:
    """Frames of both nodes in, frames that arrive out.  Pure: times are arguments, in ns."""

    def __init__(self, scenario: Scenario, database: Database) -> None:
        timing = scenario.bus_timing
        self._rng = np.random.default_rng([timing.seed, 2])
        self._jitter_ns = timing.jitter_s * 1e9
        # Without faults, the usual case, frames take the short way.
        self._faults = FrameFaults(scenario.fault, database, self._rng) if scenario.fault else None
        self._bus = VirtualBus(timing)
        self._babbled_ns = 0

    def offer(self, time_ns: int, frame_id: int, data: bytes, sender: Sender) -> None:
        """Let ``sender`` queue a frame, unless a fault has it otherwise."""
        if sender is Sender.VEHICLE and self._jitter_ns:
            time_ns += int(self._rng.uniform(0.0, self._jitter_ns))
        if self._faults is None:
            self._bus.offer(time_ns, frame_id, data, sender)
            return
        for frame in self._faults.pass_on(TimedFrame(time_ns, frame_id, data), sender):
            self._bus.offer(frame.time_ns, frame.frame_id, frame.data, sender, frame.mailbox)

    def run_until(self, now_ns: int) -> list[Delivery]:
        """Carry the bus on to ``now_ns``; returns the frames that arrive, in order."""
        if self._faults is None:
            return self._bus.run_until(now_ns)
        for frame in self._faults.babble(self._babbled_ns, now_ns):
            self._bus.offer(frame.time_ns, frame.frame_id, frame.data, Sender.VEHICLE)
        self._babbled_ns = max(now_ns, self._babbled_ns)
        return [
            delivery
            for delivery in self._bus.run_until(now_ns)
            if delivery.frame.sender is Sender.VEHICLE
            or not self._faults.deaf(delivery.time_ns * 1e-9)
        ]

    @property
    def next_arrival_ns(self) -> int | None:
        """When the frame on the wire ends, None if there is none."""
        return self._bus.next_arrival_ns
