"""The tick: drain, decide, send; stamped, recorded, and never brought down by a bad one."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from tcs_hil.canbus.port import Frame
from tcs_hil.runtime.clock import Clock
from tcs_hil.runtime.record import Record, record
from tcs_hil.runtime.seams import Node, Pipeline, Port
from tcs_hil.runtime.stopwatch import TimedController
from tcs_hil.runtime.tick import Insight, Pass, Stamps, Tick
from tcs_hil.runtime.transitions import TransitionLog
from tcs_hil.runtime.trigger import Trigger
from tcs_hil.signals import Command, Measurement
from tcs_hil.trace import Trace

logger = logging.getLogger(__name__)


@dataclass
class Loop:
    """Turns the crank: one tick for every time the trigger says so.

    ``write`` takes the record of every tick; ``healthy`` hears of those that
    were neither late nor broken, which ``overruns`` and ``failures`` count.
    ``laws`` are the pipeline's own controllers, read for the time they took.
    """

    trigger: Trigger
    port: Port
    node: Node
    pipeline: Pipeline
    laws: tuple[TimedController, TimedController]
    clock: Clock
    write: Callable[[Record], None]
    healthy: Callable[[int], None]
    overruns: int = field(init=False)
    failures: int = field(init=False)

    def __post_init__(self) -> None:
        self.overruns = 0
        self.failures = 0
        self._transitions = TransitionLog()

    def run(self, stop_requested: Callable[[], bool]) -> None:
        """Tick until asked to stop.  A lost interface is the port's to count and to reopen."""
        while not stop_requested():
            tick = self.trigger.wait()
            if tick is not None:
                self._tick(tick)

    def _tick(self, tick: Tick) -> None:
        failures = self.failures
        frames = self.trigger.frames(tick)
        measurement = self._drain(frames, tick)
        received_ns = self.clock.now_ns()
        command = self._decide(measurement)
        stepped_ns = self.clock.now_ns()
        self._send(command, tick)
        sent_ns = self.clock.now_ns()
        stamps = Stamps(received_ns, stepped_ns, sent_ns)
        failed, overrun = self.failures > failures, sent_ns > tick.deadline_ns
        self._account(Pass(tick, stamps, len(frames), measurement, command, failed, overrun))

    def _drain(self, frames: Sequence[Frame], tick: Tick) -> Measurement:
        for frame in frames:
            self.node.feed(frame.frame_id, frame.data, frame.stamp_ns)
        return self.node.measurement(tick.now_ns, self.port.condition())

    def _decide(self, measurement: Measurement) -> Command:
        try:
            return self.pipeline.step(measurement)
        except Exception:  # whatever our own code did, the car must get its torque back
            if not self.failures:
                logger.exception("a tick failed; the torque goes back to the driver")
            self.failures += 1
            return self.pipeline.abandon(measurement)

    def _send(self, command: Command, tick: Tick) -> None:
        for frame_id, data in self.node.frames(command, tick.now_ns, self.overruns):
            self.port.send(frame_id, data)
        self.trigger.done(tick)

    def _account(self, made: Pass) -> None:
        if made.overrun:
            self.overruns += 1
        elif not made.failed:
            self.healthy(made.stamps.sent_ns)
        self.pipeline.sent(made.overrun)
        self._transitions.note(made.command, made.stamps.sent_ns)
        trace = self.pipeline.trace
        if trace is not None:
            self.write(record(made, self._insight(trace)))

    def _insight(self, trace: Trace) -> Insight:
        left, right = self.laws
        solve_ns = (left.lap_ns(), right.lap_ns())
        node = self.node
        return Insight(
            trace, solve_ns, node.newest_wheel_stamp_ns, self.port.counters, node.counters
        )
