"""A polite end: the first SIGTERM or SIGINT asks, the second one insists."""

from __future__ import annotations

import signal
import time
from types import FrameType
from typing import Self

SIGNALS = (signal.SIGTERM, signal.SIGINT)
INSISTING_S = 0.5


class StopRequest:
    """Context in which SIGTERM and SIGINT only set a flag, so that a tick is never cut in two.

    A second signal, half a second or more after the first, has the default action
    and ends the process even if the loop no longer turns.  Sooner it is the same
    wish said twice: `timeout` signals the process and then its group.  Main thread only.
    """

    def __init__(self) -> None:
        self._requested_s: float | None = None
        self._previous = {number: signal.getsignal(number) for number in SIGNALS}

    def requested(self) -> bool:
        """Whether somebody has asked the process to end."""
        return self._requested_s is not None

    def __enter__(self) -> Self:
        for number in SIGNALS:
            signal.signal(number, self._ask)
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._previous.items():
            signal.signal(number, handler)

    def _ask(self, number: int, _frame: FrameType | None) -> None:
        now_s = time.monotonic()
        if self._requested_s is None:
            self._requested_s = now_s
        elif now_s - self._requested_s >= INSISTING_S:
            signal.signal(number, signal.SIG_DFL)
            signal.raise_signal(number)
