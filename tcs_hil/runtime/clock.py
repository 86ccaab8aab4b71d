"""The one clock the real-time side obeys: CLOCK_MONOTONIC, in nanoseconds."""

from __future__ import annotations

import time
from typing import Protocol


class Clock(Protocol):
    """What a trigger needs to know of time; tests inject a scripted one."""

    def now_ns(self) -> int:
        """Return the monotonic time."""
        ...

    def sleep_until(self, deadline_ns: int) -> None:
        """Return at ``deadline_ns`` or just after it; at once when it has passed."""
        ...


class MonotonicClock:
    """CLOCK_MONOTONIC: never stepped by NTP, shared by every process of the machine.

    That is also the base of kernel receive stamps after conversion and of the
    plant emulator, so that times of both processes can be subtracted.

    The last ``spin_ns`` before a deadline are not slept but waited for awake: a
    core that is busy has no sleep state to leave and no other thread to wait for.
    """

    def __init__(self, spin_ns: int = 0) -> None:
        self._spin_ns = spin_ns

    def now_ns(self) -> int:
        """Return CLOCK_MONOTONIC."""
        return time.monotonic_ns()

    def sleep_until(self, deadline_ns: int) -> None:
        """Sleep until the absolute ``deadline_ns``, the last of it awake.

        CPython's ``sleep`` is a ``clock_nanosleep`` to an absolute time that is
        resumed after a signal, so a handler runs but the deadline holds: a stop
        request is seen one period later at the latest.
        """
        remaining_ns = deadline_ns - self._spin_ns - time.monotonic_ns()
        if remaining_ns > 0:
            time.sleep(remaining_ns * 1e-9)
        if self._spin_ns:
            while time.monotonic_ns() < deadline_ns:
                pass
