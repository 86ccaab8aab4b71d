"""The plant as a node on the bus: what both paces of the loop, and a bench in process, share."""

from __future__ import annotations

from collections import deque
from typing import Protocol

from plant_emulator.bench_control import PREPARED, ControlDesk
from plant_emulator.link import Link
from plant_emulator.plant import Plant
from plant_emulator.recording import TruthRecorder
from plant_emulator.virtual_bus import Sender
from tcs_hil.canbus.bench_control import AS_IN_SCENARIO, BenchControl
from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.vehicle_node import VehicleNode
from tcs_hil.signals import TorqueLimits

PERIOD_NS = 2_000_000


class Mouth(Protocol):
    """Where the vehicle's frames go: a `CanPort`, or a service in the same process."""

    def send(self, frame_id: int, data: bytes, /) -> bool:
        """Send one frame; False if the bus refused it."""
        ...


class Emulator:
    """Moves signals from the plant to the bus and torque limits from the bus to the plant.

    Times are nanoseconds since the start of the run on the clock of the pace that
    drives it; nothing here looks at a clock.  ``live`` says that the service reads
    the bus when it likes (real time); otherwise it does so ``answer_s`` of the
    scenario after each sample, and `publish` brings the bus to that instant.
    ``allow_control`` lets whoever sends control frames drive.
    """

    def __init__(
        self,
        plant: Plant,
        node: VehicleNode,
        port: Mouth,
        recorder: TruthRecorder,
        *,
        live: bool = False,
        allow_control: bool = False,
    ) -> None:
        timing = plant.scenario.bus_timing
        self.plant = plant
        self._node = node
        self._port = port
        self._recorder = recorder
        self._database = load_database()
        self._link = Link(plant.scenario, self._database)
        self._desk = ControlDesk(self._database, allowed=allow_control)
        self._control = AS_IN_SCENARIO
        self._bench_done_id = self._database.messages["BenchTickDone"].frame_id
        self._limit_delay_ns = round(timing.limit_delay_s * 1e9)
        self._answer_ns = 0 if live else round(timing.answer_s * 1e9)
        self._now_ns = 0
        self._heard_ns: int | None = None
        self._arrivals: deque[tuple[int, TorqueLimits]] = deque()
        self._dark = False

    def publish(self) -> None:
        """Sample the sensors, queue every frame that is due, put the truth on record."""
        self._wake_or_sleep()
        for frame_id, data in self._node.frames(self.plant.signals(), self._now_ns):
            self._link.offer(self._now_ns, frame_id, data, Sender.VEHICLE)
        self._recorder.add(self.plant.row)
        self.relay(self._now_ns + self._answer_ns)

    def relay(self, until_ns: int) -> None:
        """Carry the bus on: send the vehicle's frames that are through, take the service's."""
        for delivery in self._link.run_until(until_ns):
            frame = delivery.frame
            if frame.sender is Sender.VEHICLE:
                self._port.send(frame.frame_id, frame.data)
            else:
                self._take(delivery.time_ns, frame.frame_id, frame.data)

    @property
    def next_arrival_ns(self) -> int | None:
        """When `relay` next has something to do, None if nothing is on the wire."""
        return self._link.next_arrival_ns

    def hear(self, frame_id: int, data: bytes, stamp_ns: int) -> None:
        """Take one frame of somebody else, queued at its node at ``stamp_ns`` or, if past, now."""
        if frame_id == self._bench_done_id:  # belongs to the bench, not to the car
            self._node.feed(frame_id, data, stamp_ns)
        elif frame_id == self._desk.frame_id:
            self._obey(self._desk.hear(data, stamp_ns))
        else:
            self._link.offer(stamp_ns, frame_id, data, Sender.SERVICE)

    @property
    def refused_controls(self) -> int:
        """How many control frames came that nobody had allowed."""
        return self._desk.refused

    def send_tick(self, tick: int) -> None:
        """Tell the service that everything of this tick has been sent (lockstep)."""
        self._port.send(*self._node.bench_tick(tick))

    def answered(self, tick: int) -> bool:
        """Whether the service has said that it sent all its answers to this tick (lockstep)."""
        return self._node.bench_tick_done == tick

    def advance_to(self, end_ns: int) -> None:
        """Integrate up to ``end_ns``; limits act from the instant they have come through."""
        self.relay(end_ns)
        limits: TorqueLimits | None = None
        while self._arrivals and self._arrivals[0][0] <= end_ns:
            arrival_ns, newer = self._arrivals.popleft()
            self._step(limits, arrival_ns)
            limits = newer
        self._step(limits, end_ns)

    def _obey(self, control: BenchControl | None) -> None:
        if control is None:
            return
        if control.fault != self._control.fault:  # one that lasts remembers how it began
            self.plant.inject(PREPARED[control.fault])
            self._link.inject(PREPARED[control.fault])
        self.plant.override(control.throttle_nm, control.mu_ratio)
        self._control = control

    def _take(self, time_ns: int, frame_id: int, data: bytes) -> None:
        self._node.feed(frame_id, data, time_ns)
        limits_ns = self._node.limits_stamp_ns
        if limits_ns is not None and limits_ns != self._heard_ns:
            self._heard_ns = limits_ns
            self._arrivals.append((time_ns + self._limit_delay_ns, self._node.limits))

    def _step(self, limits: TorqueLimits | None, end_ns: int) -> None:
        end_ns = max(end_ns, self._now_ns)
        self.plant.step(limits, (end_ns - self._now_ns) * 1e-9)
        self._now_ns = end_ns

    def _wake_or_sleep(self) -> None:
        """After a brown-out the car's electronics start anew, counters and all."""
        if self._dark and not self.plant.dark:
            self._node = VehicleNode(self._database)
        self._dark = self.plant.dark
