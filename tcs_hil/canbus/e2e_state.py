"""The E2E state machine: from the statuses of many cycles to one word about a message.

After AUTOSAR FO PRS E2E Protocol, "E2E state machine", with one window for all states:

    NO_DATA -> INIT -> VALID <-> INVALID,  INIT -> INVALID
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from tcs_hil.canbus.e2e import ERROR, OK, E2EStatus
from tcs_hil.signals import InputState

NO_DATA: Final = InputState.NO_DATA
INIT: Final = InputState.INIT
VALID: Final = InputState.VALID
INVALID: Final = InputState.INVALID


@dataclass(frozen=True, slots=True)
class Threshold:
    """What the window must show to become, or to stay, VALID."""

    min_ok: int
    max_error: int


@dataclass(frozen=True, slots=True)
class WindowSpec:
    """The last ``size`` statuses, and their threshold in each state but NO_DATA.

    ``valid`` must ask no more than the other two, or VALID would not last a cycle.
    """

    size: int
    init: Threshold
    valid: Threshold
    invalid: Threshold


class StateMachine:
    """State of one message.  The window is two words of bits: fast, and never grows."""

    __slots__ = ("_errors", "_mask", "_oks", "_spec", "_threshold", "state")

    def __init__(self, spec: WindowSpec) -> None:
        self._spec = spec
        self._mask = (1 << spec.size) - 1
        self._oks = 0
        self._errors = 0
        self._threshold = spec.init
        self.state: InputState = NO_DATA

    def add(self, status: E2EStatus) -> None:
        """Count the status of a frame; as in the standard the first one only wakes INIT."""
        if self.state is not NO_DATA:
            self._slide(1, status is OK, status is ERROR)
        elif status is not ERROR:
            self.state = INIT

    def add_missed(self, cycles: int) -> None:
        """Count ``cycles`` >= 1 that were NOT_AVAILABLE, all at once."""
        if self.state is not NO_DATA:
            self._slide(min(cycles, self._spec.size), ok=False, error=False)

    def _slide(self, steps: int, ok: bool, error: bool) -> None:
        self._oks = (self._oks << steps | ok) & self._mask
        self._errors = (self._errors << steps | error) & self._mask
        tolerable = self._errors.bit_count() <= self._threshold.max_error
        if tolerable and self._oks.bit_count() >= self._threshold.min_ok:
            self._enter(VALID, self._spec.valid)
        elif not tolerable or self.state is not INIT:
            self._enter(INVALID, self._spec.invalid)

    def _enter(self, state: InputState, threshold: Threshold) -> None:
        self.state = state
        self._threshold = threshold
