"""Real-time pace: the plant keeps an absolute 2 ms grid and says how well."""

from __future__ import annotations

from array import array
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

    Grid instants are multiples of 2 ms of the clock, plus ``phase_ns``.  What is
    sent is the state at the instant, however late the wake-up.  After a wake-up
    late by whole periods the newest instant is served; those before it are
    integrated over but not published, so that there is no burst.
    """
    start_ns = _next_instant(clock.now_ns(), phase_ns)
    jitter_ns = array("q")  # eight bytes an instant, for runs of a day
    instant_ns = start_ns
    while not emulator.plant.finished and not stop():
        _relay_until(instant_ns, start_ns, emulator, port, clock)
        clock.sleep_until(instant_ns)
        woken_ns = clock.now_ns()
        jitter_ns.append(woken_ns - instant_ns)
        instant_ns = max(instant_ns, _last_instant(woken_ns, phase_ns))
        _hear(emulator, port, start_ns)
        emulator.advance_to(instant_ns - start_ns)
        emulator.publish()
        instant_ns += PERIOD_NS
    return np.array(jitter_ns, dtype=np.int64)


def _relay_until(
    instant_ns: int, start_ns: int, emulator: Emulator, port: CanPort, clock: Clock
) -> None:
    """Wake for every frame that comes off the emulated wire before ``instant_ns``."""
    while (arrival_ns := emulator.next_arrival_ns) is not None:
        if start_ns + arrival_ns >= instant_ns:
            return
        clock.sleep_until(start_ns + arrival_ns)
        _hear(emulator, port, start_ns)
        emulator.relay(max(arrival_ns, min(clock.now_ns(), instant_ns) - start_ns))


def _hear(emulator: Emulator, port: CanPort, start_ns: int) -> None:
    for frame in port.receive():
        emulator.hear(frame.frame_id, frame.data, frame.stamp_ns - start_ns)


def _last_instant(now_ns: int, phase_ns: int) -> int:
    return (now_ns - phase_ns) // PERIOD_NS * PERIOD_NS + phase_ns


def _next_instant(now_ns: int, phase_ns: int) -> int:
    return _last_instant(now_ns, phase_ns) + PERIOD_NS
