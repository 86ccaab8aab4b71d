"""A polite end: the first SIGTERM or SIGINT asks, the second one insists."""

from __future__ import annotations

import signal
from types import FrameType
from typing import Self

SIGNALS = (signal.SIGTERM, signal.SIGINT)


class StopRequest:
    """Context in which SIGTERM and SIGINT only set a flag, so that a tick is never cut in two.

    The second signal finds the default action back in place and ends the
    process even if the loop no longer turns.  Main thread only.
    """

    def __init__(self) -> None:
        self._requested = False
        self._previous = {number: signal.getsignal(number) for number in SIGNALS}

    def requested(self) -> bool:
        """Whether somebody has asked the process to end."""
        return self._requested

    def __enter__(self) -> Self:
        for number in SIGNALS:
            signal.signal(number, self._ask)
        return self

    def __exit__(self, *_: object) -> None:
        for number, handler in self._previous.items():
            signal.signal(number, handler)

    def _ask(self, _number: int, _frame: FrameType | None) -> None:
        self._requested = True
        for number in SIGNALS:
            signal.signal(number, signal.SIG_DFL)
