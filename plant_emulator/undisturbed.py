"""Asking the operating system and Python not to disturb a 2 ms grid."""

from __future__ import annotations

import contextlib
import gc
import os
from collections.abc import Iterator

FIFO_PRIORITY = 40
"""Below the service under test: where they share a processor, the plant gives way."""


@contextlib.contextmanager
def undisturbed() -> Iterator[None]:
    """Run at real-time priority where that is allowed, and without garbage collection."""
    policy, parameters = os.sched_getscheduler(0), os.sched_getparam(0)
    gc.collect()
    gc.freeze()
    gc.disable()
    with contextlib.suppress(PermissionError):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(FIFO_PRIORITY))
    try:
        yield
    finally:
        os.sched_setscheduler(0, policy, parameters)
        gc.enable()
        gc.unfreeze()
