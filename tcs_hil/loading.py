"""Ctrl-C while a program is still loading: it ends at once and says nothing.

An interrupt between two imports has nobody to catch it, and within one a
library may take it for a failure of its own.
"""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

INTERRUPTED = 130


@contextmanager
def loading() -> Iterator[None]:
    """A context for imports alone: nothing has begun that would have to be ended in order.

    SIGINT that is ignored, or that somebody else has a handler for, is left as it is.
    """
    ours = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if ours:
        signal.signal(signal.SIGINT, _end)
    try:
        yield
    finally:
        if ours:
            signal.signal(signal.SIGINT, signal.default_int_handler)


def _end(_number: int, _frame: FrameType | None) -> None:
    os._exit(INTERRUPTED)
