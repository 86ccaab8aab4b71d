"""Real-time pace: the plant keeps an absolute 2 ms grid and says how well."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from plant_emulator.emulator import PERIOD_NS, Emulator
from tcs_hil.canbus.port import CanPort
from tcs_hil.runtime.clock import Clock

Jitter = NDArray[np.int64]  # (grid instants kept,) ns, wake - scheduled


def run_realtime(
    emulator: Emulator, port: CanPort, clock: Clock, stop: Callable[[], bool], phase_ns: int = 0
) -> Jitter:
    """Drive the plant to the end of its scenario, or until ``stop()``; returns the wake jitter.

    Grid instants are multiples of 2 ms of the clock, plus ``phase_ns``.  The
    state is that of the instant, however late the wake-up; a whole period late,
    the instant is integrated over but not published, and there is no burst.
    """
    start_ns = _next_instant(clock.now_ns(), phase_ns)
    jitter_ns = []
    instant_ns = start_ns
    while not emulator.plant.finished and not stop():
        clock.sleep_until(instant_ns)
        jitter_ns.append(clock.now_ns() - instant_ns)
        for frame in port.receive():
            emulator.hear(frame.frame_id, frame.data, frame.stamp_ns - start_ns)
        emulator.advance_to(instant_ns - start_ns)
        emulator.publish()
        instant_ns = max(instant_ns + PERIOD_NS, _last_instant(clock.now_ns(), phase_ns))
    return np.array(jitter_ns, dtype=np.int64)


def _last_instant(now_ns: int, phase_ns: int) -> int:
    return (now_ns - phase_ns) // PERIOD_NS * PERIOD_NS + phase_ns


def _next_instant(now_ns: int, phase_ns: int) -> int:
    return _last_instant(now_ns, phase_ns) + PERIOD_NS
