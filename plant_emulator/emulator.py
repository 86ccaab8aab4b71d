"""The plant as a node on the bus: what both paces of the loop share."""

from __future__ import annotations

from collections import deque
from typing import Protocol

from plant_emulator.plant import Plant
from plant_emulator.recording import TruthRecorder
from tcs_hil.canbus.vehicle_node import VehicleNode
from tcs_hil.signals import TorqueLimits

PERIOD_NS = 2_000_000


class Sender(Protocol):
    """Where frames go: a port of a bus, or a service in the same process."""

    def send(self, frame_id: int, data: bytes) -> bool:
        """Send one frame; False if it was not taken."""
        ...


class Emulator:
    """Moves signals from the plant to the bus and torque limits from the bus to the plant.

    Times are nanoseconds since the start of the run on the clock of the pace
    that drives it; nothing here looks at a clock.
    """

    def __init__(
        self, plant: Plant, node: VehicleNode, port: Sender, recorder: TruthRecorder
    ) -> None:
        self.plant = plant
        self._node = node
        self._port = port
        self._recorder = recorder
        self._now_ns = 0
        self._heard_ns: int | None = None
        self._arrivals: deque[tuple[int, TorqueLimits]] = deque()

    def publish(self) -> None:
        """Sample the sensors, send every frame that is due and put the truth on record."""
        for frame_id, data in sorted(self._node.frames(self.plant.signals(), self._now_ns)):
            self._port.send(frame_id, data)
        self._recorder.add(self.plant.row)

    def send_tick(self, tick: int) -> None:
        """Tell the service that everything of this tick has been sent (lockstep)."""
        self._port.send(*self._node.bench_tick(tick))

    def answered(self, tick: int) -> bool:
        """Whether the service has said that it sent all its answers to this tick (lockstep)."""
        return self._node.bench_tick_done == tick

    def hear(self, frame_id: int, data: bytes, stamp_ns: int) -> None:
        """Take one received frame; limits in it act from ``stamp_ns`` on."""
        self._node.feed(frame_id, data, stamp_ns)
        limits_ns = self._node.limits_stamp_ns
        if limits_ns is not None and limits_ns != self._heard_ns:
            self._heard_ns = limits_ns
            self._arrivals.append((stamp_ns, self._node.limits))

    def advance_to(self, end_ns: int) -> None:
        """Integrate up to ``end_ns``; each pair of limits acts from the instant it arrived."""
        limits: TorqueLimits | None = None
        while self._arrivals and self._arrivals[0][0] <= end_ns:
            arrival_ns, newer = self._arrivals.popleft()
            self._step(limits, arrival_ns)
            limits = newer
        self._step(limits, end_ns)

    def _step(self, limits: TorqueLimits | None, end_ns: int) -> None:
        end_ns = max(end_ns, self._now_ns)
        self.plant.step(limits, (end_ns - self._now_ns) * 1e-9)
        self._now_ns = end_ns
