"""How punctual this machine is right now: our own sleep, and cyclictest's where it is installed."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from tcs_hil.runtime.clock import Clock
from tcs_hil.runtime.doctor.finding import Finding, fail, ok, warn
from tcs_hil.runtime.doctor.machine import Machine
from tcs_hil.runtime.realtime import FIFO_PRIORITY, Grant
from tcs_hil.runtime.trigger import Grid

PERIOD_NS = 2_000_000
GOOD_US = 200.0  # a tenth of the period
US_PER_NS = 1e-3
_MEND = "SCHED_FIFO (see above), a core of its own (tick.cpu), or tick.spin_us = 100"
_CYCLICTEST = re.compile(r"Min:\s*(\d+) .*Avg:\s*(\d+) Max:\s*(\d+)")


def wake_jitter_us(
    clock: Clock, wakes: int, period_ns: int = PERIOD_NS, phase_ns: int = 0
) -> NDArray[np.float64]:
    """Sleep to ``wakes`` points of the grid and return how late each wake was, µs (wakes,)."""
    late_ns = np.zeros(wakes)
    grid = Grid(clock.now_ns(), period_ns, phase_ns)
    for wake in range(wakes):
        scheduled_ns, _ = grid.next_after(clock.now_ns())
        clock.sleep_until(scheduled_ns)
        late_ns[wake] = clock.now_ns() - scheduled_ns
    return late_ns * US_PER_NS


def baseline(jitter_us: NDArray[np.float64], grants: Sequence[Grant]) -> Finding:
    """Judge the wakes of a tick that does nothing; ``grants`` is what it was given."""
    median, p99, p99_9 = np.quantile(jitter_us, (0.5, 0.99, 0.999), method="inverted_cdf").tolist()
    missing = [grant.what for grant in grants if not grant.got]
    found = (
        f"{len(jitter_us)} wakes: p50 {median:.0f}, p99 {p99:.0f}, p99.9 {p99_9:.0f}, "
        f"max {jitter_us.max():.0f} µs" + (f", without {', '.join(missing)}" if missing else "")
    )
    if median > PERIOD_NS * US_PER_NS:
        return fail("wake jitter", found, "end what keeps all cores busy")
    if p99_9 > GOOD_US:
        return warn("wake jitter", found, _MEND)
    return ok("wake jitter", found)


def cyclictest(machine: Machine, seconds: int) -> Finding:
    """What the usual yardstick says of this machine."""
    output = machine.run(
        "cyclictest",
        *("--quiet", "--mlockall", "--threads=1", f"--priority={FIFO_PRIORITY}"),
        *(f"--interval={PERIOD_NS // 1000}", f"--duration={seconds}"),
    )
    seen = _CYCLICTEST.search(output or "")
    if seen is None:
        return ok("cyclictest", "not run: not installed (rt-tests), or not permitted")
    least, mean, most = seen.groups()
    return ok("cyclictest", f"min {least}, mean {mean}, max {most} µs")
