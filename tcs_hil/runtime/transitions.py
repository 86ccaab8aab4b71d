"""One line on stderr for every change of state that somebody should know of; never a flood."""

from __future__ import annotations

import logging
from collections import deque
from typing import Final

from tcs_hil.fault_codes import FaultCode
from tcs_hil.signals import Command, TcsState

logger = logging.getLogger(__name__)

STANDBY: Final = TcsState.STANDBY
ACTIVE: Final = TcsState.ACTIVE

MOST_LINES: Final = 10
WITHIN_NS: Final = 1_000_000_000

Condition = tuple[TcsState, int]


class TransitionLog:
    """Logs state and fault code when they change, at most ten times in a second.

    STANDBY and ACTIVE take turns whenever a wheel slips: they are one here, and
    the flight recorder has them.  What a flood left out is counted in the next
    line, and the condition after it is logged however it ends.
    """

    def __init__(self) -> None:
        self._logged: Condition = (TcsState.INIT, FaultCode.NONE)
        self._seen: Condition = self._logged
        self._unlogged = 0
        self._lines_ns: deque[int] = deque(maxlen=MOST_LINES)

    def note(self, command: Command, now_ns: int) -> None:
        """Hear what a tick has decided."""
        state = STANDBY if command.state is ACTIVE else command.state
        condition = (state, command.fault_code)
        if condition != self._seen:
            self._seen = condition
            self._unlogged += 1
        if condition != self._logged and self._may_speak(now_ns):
            self._speak(condition, now_ns)

    def _may_speak(self, now_ns: int) -> bool:
        lines_ns = self._lines_ns
        return len(lines_ns) < MOST_LINES or now_ns - lines_ns[0] >= WITHIN_NS

    def _speak(self, condition: Condition, now_ns: int) -> None:
        state, code = condition
        before = self._logged[0]
        logger.log(
            _level(state, before),
            "state=%s before=%s code=%d fault=%s unlogged=%d time_ns=%d",
            *(state.name, before.name, code, FaultCode(code).name, self._unlogged - 1, now_ns),
        )
        self._logged = condition
        self._unlogged = 0
        self._lines_ns.append(now_ns)


def _level(state: TcsState, before: TcsState) -> int:
    if state is TcsState.FAULT:
        return logging.ERROR
    quiet = (TcsState.INIT, TcsState.STANDBY)
    return logging.INFO if state in quiet and before in quiet else logging.WARNING
