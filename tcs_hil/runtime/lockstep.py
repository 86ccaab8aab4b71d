"""Ticks announced by the bench: the plant waits for the answer, no wall clock anywhere."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from typing import Final

from tcs_hil.canbus.port import Frame
from tcs_hil.runtime.clock import Clock
from tcs_hil.runtime.seams import Bench, Port
from tcs_hil.runtime.tick import Tick

STOP_POLL_S: Final = 0.1
BACKLOG_FRAMES: Final = 1024  # a bus on which no bench ever ticks must not grow the process
FOREVER_NS: Final = 2**63 - 1


class LockstepTrigger:
    """Ticks when the plant says that it has sent everything of a tick, and answers it.

    The number of the tick times the period is the only time the decisions see,
    so that a run gives the same bytes at any speed of the machine; there is no
    deadline, hence no overrun.  ``tick_id`` is the identifier of ``BenchTick``.
    """

    def __init__(
        self, clock: Clock, port: Port, bench: Bench, tick_id: int, period_ns: int
    ) -> None:
        self._clock = clock
        self._port = port
        self._bench = bench
        self._tick_id = tick_id
        self._period_ns = period_ns
        self._waiting: deque[Frame] = deque(maxlen=BACKLOG_FRAMES)
        self._inputs: deque[Frame] = deque(maxlen=BACKLOG_FRAMES)
        self._last: int | None = None

    def wait(self) -> Tick | None:
        """Wait for the bench's next tick; None when a tenth of a second brings no frame."""
        if not self._waiting and self._port.wait(STOP_POLL_S):
            self._waiting.extend(self._port.receive())
        number = self._announced()
        return None if number is None else self._tick(number)

    def frames(self, tick: Tick) -> Sequence[Frame]:
        """Return the frames sent before the tick was announced, stamped with its time."""
        inputs = [Frame(frame.frame_id, frame.data, tick.now_ns) for frame in self._inputs]
        self._inputs.clear()
        return inputs

    def done(self, tick: Tick) -> None:
        """Let the plant go on."""
        self._port.send(*self._bench.bench_tick_done(tick.number))

    def _announced(self) -> int | None:
        """Set frames aside as inputs up to the next good announcement; its number."""
        while self._waiting:
            frame = self._waiting.popleft()
            if frame.frame_id != self._tick_id:
                self._inputs.append(frame)
            elif self._bench.feed(frame.frame_id, frame.data, frame.stamp_ns):
                return self._bench.bench_tick
        return None

    def _tick(self, number: int) -> Tick:
        wake_ns = self._clock.now_ns()
        # A plant that was restarted counts from zero again: nothing was skipped then.
        skipped = 0 if self._last is None else max(number - self._last - 1, 0)
        self._last = number
        return Tick(number, wake_ns, wake_ns, number * self._period_ns, FOREVER_NS, skipped)
