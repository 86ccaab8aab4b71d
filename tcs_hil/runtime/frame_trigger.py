"""Ticks with a frame, so that the phase between two nodes costs no latency."""

from __future__ import annotations

from collections.abc import Sequence

from tcs_hil.canbus.port import Frame
from tcs_hil.runtime.clock import Clock
from tcs_hil.runtime.seams import Port
from tcs_hil.runtime.tick import Tick


class FrameTrigger:
    """Ticks when ``frame_id`` arrives, and without it half a period after it was due.

    Losing frames, or all of them, does not stop the ticks.  A frame that comes
    within a quarter of a period after a tick is an input and no tick of its own;
    the next one is expected a period after it.
    """

    def __init__(self, clock: Clock, port: Port, frame_id: int, period_ns: int) -> None:
        self._clock = clock
        self._port = port
        self._frame_id = frame_id
        self._period_ns = period_ns
        self._due_ns = 0
        self._accept_from_ns = 0
        self._number = -1
        self._inputs: list[Frame] = []

    def wait(self) -> Tick:
        """Wait for the frame, a period and a half after the one before at most."""
        if self._number < 0:  # time that passed between construction and start is nobody's tick
            self._due_ns = self._clock.now_ns() + self._period_ns
        arrival_ns = self._arrival_ns()
        wake_ns = self._clock.now_ns()
        heard_ns = wake_ns - self._period_ns // 2 if arrival_ns is None else arrival_ns
        skipped = max(round((heard_ns - self._due_ns) / self._period_ns), 0)
        predicted_ns = self._due_ns + skipped * self._period_ns
        scheduled_ns = predicted_ns if arrival_ns is None else arrival_ns
        self._due_ns = scheduled_ns + self._period_ns
        self._accept_from_ns = wake_ns + self._period_ns // 4
        self._number += 1 + skipped
        return Tick(self._number, scheduled_ns, wake_ns, wake_ns, self._due_ns, skipped)

    def frames(self, _tick: Tick) -> Sequence[Frame]:
        """Return what has come with the frame and since the last tick."""
        inputs, self._inputs = self._inputs, []
        return inputs

    def done(self, _tick: Tick) -> None:
        """Nobody waits for this tick."""

    def _arrival_ns(self) -> int | None:
        """Stamp of the frame that starts the tick; None when it stays away."""
        while True:
            left_ns = max(self._due_ns + self._period_ns // 2 - self._clock.now_ns(), 0)
            if not self._port.wait(left_ns * 1e-9):
                return None
            frames = self._port.receive()
            self._inputs += frames
            stamps = [frame.stamp_ns for frame in frames if frame.frame_id == self._frame_id]
            if stamps and stamps[-1] >= self._accept_from_ns:
                return stamps[-1]
            if stamps:  # not the start of a tick, but it says when the next one is due
                self._due_ns = stamps[-1] + self._period_ns
            if not left_ns:
                return None
