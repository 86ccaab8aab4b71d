"""What the operating system gives a process that must wake on time, privileged or not.

Everything degrades politely: each step says whether it was granted, and if not
what would grant it.
"""

from __future__ import annotations

import ctypes
import gc
import os
from typing import NamedTuple

FIFO_PRIORITY = 50  # above ordinary threads, below the kernel's own interrupt threads
MCL_CURRENT, MCL_FUTURE = 1, 2
PR_SET_TIMERSLACK = 29

_libc = ctypes.CDLL(None, use_errno=True)


class Grant(NamedTuple):
    """One thing asked of the operating system and its answer."""

    what: str
    got: bool
    why: str


def prepare(cpu: int | None = None, priority: int = FIFO_PRIORITY) -> list[Grant]:
    """Ask for all a 2 ms tick can use: SCHED_FIFO at ``priority``, and ``cpu`` to stay on, if any.

    Call it once everything is built: what exists by then is what the garbage
    collector will ignore and what memory is locked first.
    """
    grants = [_quiet_collector(), _exact_timers(), _locked_memory(), _fifo(priority)]
    return grants if cpu is None else [*grants, _pinned(cpu)]


def _quiet_collector() -> Grant:
    """A tick leaves no reference cycles, so nothing piles up while the collector is off."""
    gc.collect()
    gc.freeze()
    gc.disable()
    return Grant("garbage collector off", True, "the tick makes no cycles")


def _exact_timers() -> Grant:
    """Without it an ordinary thread is woken up to 50 µs late on purpose."""
    got = _libc.prctl(PR_SET_TIMERSLACK, 1, 0, 0, 0) == 0
    return Grant("timer slack 1 ns", got, "" if got else _last_error())


def _locked_memory() -> Grant:
    got = _libc.mlockall(MCL_CURRENT | MCL_FUTURE) == 0
    why = "no page faults" if got else f"{_last_error()}: raise LimitMEMLOCK / ulimit -l"
    return Grant("memory locked", got, why)


def _fifo(priority: int) -> Grant:
    what = f"SCHED_FIFO {priority}"
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
    except OSError as error:
        return Grant(what, False, f"{error.strerror}: raise LimitRTPRIO / ulimit -r")
    return Grant(what, True, "runs before ordinary processes")


def _pinned(cpu: int) -> Grant:
    what = f"core {cpu}"
    try:
        os.sched_setaffinity(0, {cpu})
    except (OSError, ValueError) as error:
        return Grant(what, False, f"{error}: no such core, or not in this process's set")
    return Grant(what, True, "caches stay warm")


def _last_error() -> str:
    return os.strerror(ctypes.get_errno())
