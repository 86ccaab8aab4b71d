"""What starts a tick, and the timer that usually does."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from tcs_hil.canbus.port import Frame
from tcs_hil.runtime.clock import Clock
from tcs_hil.runtime.seams import Port
from tcs_hil.runtime.tick import Tick


class Trigger(Protocol):
    """When to tick, and which frames belong to the tick."""

    def wait(self) -> Tick | None:
        """Wait for the next tick; None to let the caller look for a stop request."""
        ...

    def frames(self, tick: Tick) -> Sequence[Frame]:
        """Return what came from the bus for ``tick``, stamped on the clock of ``now_ns``."""
        ...

    def done(self, tick: Tick) -> None:
        """Everything this tick has to say is on the bus."""
        ...


class Grid:
    """Absolute points in time: multiples of the period plus a phase, none visited twice.

    Being aligned to the clock rather than to the start, the grids of two
    processes keep the phase they were given.
    """

    def __init__(self, start_ns: int, period_ns: int, phase_ns: int) -> None:
        self.period_ns = period_ns
        self._point_ns = start_ns - (start_ns - phase_ns) % period_ns

    def next_after(self, now_ns: int) -> tuple[int, int]:
        """Return the next point and how many were skipped because ``now_ns`` has passed them.

        A late caller joins the grid again at a future point: making up for lost
        ticks in a burst would act several times on the same measurement.
        """
        periods = max((now_ns - self._point_ns) // self.period_ns + 1, 1)
        self._point_ns += periods * self.period_ns
        return self._point_ns, periods - 1


class TimerTrigger:
    """Ticks on a grid of the monotonic clock, whatever the bus does."""

    def __init__(self, clock: Clock, port: Port, period_ns: int, phase_ns: int = 0) -> None:
        self._clock = clock
        self._port = port
        self._grid = Grid(clock.now_ns(), period_ns, phase_ns)
        self._number = -1

    def wait(self) -> Tick:
        """Sleep until the next grid point."""
        scheduled_ns, skipped = self._grid.next_after(self._clock.now_ns())
        if self._number < 0:
            skipped = 0  # time that passed between construction and start is nobody's tick
        self._number += 1 + skipped
        self._clock.sleep_until(scheduled_ns)
        wake_ns = self._clock.now_ns()
        deadline_ns = scheduled_ns + self._grid.period_ns
        return Tick(self._number, scheduled_ns, wake_ns, wake_ns, deadline_ns, skipped)

    def frames(self, _tick: Tick) -> Sequence[Frame]:
        """Drain the bus."""
        return self._port.receive()

    def done(self, _tick: Tick) -> None:
        """Nobody waits for this tick."""
