"""When a fault was named, when it was answered, and when all was well again."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tcs_hil.fault_codes import FaultCode
from tcs_hil.hil.faults.manoeuvres import FAULT_S
from tcs_hil.hil.faults.record import Record
from tcs_hil.hil.faults.rises import SETTLED
from tcs_hil.signals import TcsState
from tcs_hil.supervisor import PERIOD_S

HALF_TICK_S = 0.001
"""A tick at the very instant of an event belongs to it, however its time was rounded."""


@dataclass(frozen=True, slots=True)
class Story:
    """Times in s after the fault came, ``back_s`` after it went; None where it never happened.

    ``codes`` are in the order they were first named.
    """

    settled_before: bool
    codes: tuple[FaultCode, ...]
    named_s: float | None
    answered_s: float | None
    back_s: float | None


def tell(record: Record, wanted: TcsState, end_s: float) -> Story:
    """What happened from the fault on; it is answered once the state is ``wanted`` or worse."""
    settled = np.isin(record.state, SETTLED)
    after = record.time_s >= FAULT_S - HALF_TICK_S
    named = after & (record.fault_code != FaultCode.NONE)
    return Story(
        settled_before=bool(settled[~after][-1]),
        codes=tuple(FaultCode(code) for code in dict.fromkeys(record.fault_code[named].tolist())),
        named_s=_first(record, named),
        answered_s=_first(record, after & (record.state >= wanted)),
        back_s=_back(record, after & ~settled, end_s),
    )


def _first(record: Record, holds: NDArray[np.bool_]) -> float | None:
    return float(record.time_s[np.argmax(holds)]) - FAULT_S if holds.any() else None


def _back(record: Record, unsettled: NDArray[np.bool_], end_s: float) -> float | None:
    """From the fault's end to the first tick after the last that was not settled."""
    if unsettled[-1]:
        return None
    if not unsettled.any():
        return 0.0
    last_s = float(record.time_s[unsettled][-1])
    return max(last_s + PERIOD_S - end_s, 0.0)
