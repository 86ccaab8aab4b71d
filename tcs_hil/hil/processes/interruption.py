"""Ctrl-C and SIGTERM at a bench of several processes: it ends from the inside out."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import resource_tracker
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM)


@contextmanager
def interrupted_by_sigterm() -> Iterator[None]:
    """Let SIGTERM end the bench as Ctrl-C does: from the inside out, no program left behind."""

    def interrupt(_number: int, _frame: FrameType | None) -> None:
        raise KeyboardInterrupt

    previous = signal.signal(signal.SIGTERM, interrupt)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, previous)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Put both off to the end of the context: what is begun in it is begun as a whole.

    Processes made in it never hear SIGINT, which a terminal sends to all of them
    and which would end one still being made with a traceback: the bench ends them.
    Main thread only.
    """
    asked: list[int] = []

    def note(number: int, _frame: FrameType | None) -> None:
        asked.append(number)

    resource_tracker.ensure_running()  # started in the context it would end what blocks SIGINT
    previous = {number: signal.signal(number, note) for number in SIGNALS}
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})  # inherited, unlike a handler
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
        for number, handler in previous.items():
            signal.signal(number, handler)
        if asked:
            signal.raise_signal(asked[0])
