"""All checks in the order of a newcomer's questions."""

from __future__ import annotations

from collections.abc import Iterator

from tcs_hil.runtime.clock import MonotonicClock
from tcs_hil.runtime.doctor import bus, cores, kernel, limits, software
from tcs_hil.runtime.doctor.baseline import PERIOD_NS, baseline, cyclictest, wake_jitter_us
from tcs_hil.runtime.doctor.finding import Finding
from tcs_hil.runtime.doctor.machine import Machine
from tcs_hil.runtime.realtime import prepare

NS_PER_S = 1_000_000_000

CHECKS = (
    kernel.preemption,
    kernel.clock_source,
    kernel.timers,
    cores.governor,
    cores.isolation,
    limits.realtime_priority,
    limits.locked_memory,
    limits.receive_buffer,
    software.bus_software,
    software.solvers,
    software.native_step,
    software.compiled_tick,
    bus.socketcan,
)


def examine(machine: Machine, channel: str, seconds: int) -> Iterator[Finding]:
    """Yield a finding per check; the last two measure ``seconds`` each, at real-time priority.

    This process is not fit for much else afterwards: its garbage collector is off.
    """
    for check in CHECKS:
        yield check(machine)
    yield bus.interface(machine, channel)
    yield cyclictest(machine, seconds)
    grants = prepare()
    yield baseline(wake_jitter_us(MonotonicClock(), seconds * NS_PER_S // PERIOD_NS), grants)
