"""Records of runs that never were, to be judged."""

from __future__ import annotations

import math

import numpy as np

from tcs_hil.hil.faults.record import Record
from tcs_hil.signals import TcsState

TICKS = 600
"""1.2 s: the fault comes with tick 350."""


def calm() -> Record:
    """ACTIVE throughout: 100 Nm wanted and allowed of 250 Nm, every input fresh."""
    return Record(
        time_s=np.arange(TICKS) * 0.002,
        limit_nm=np.full((TICKS, 2), 100.0),
        request_nm=np.full((TICKS, 2), 250.0),
        wanted_nm=np.full((TICKS, 2), 100.0),
        estimate=np.ones((TICKS, 3)),
        wheel_age_s=np.full(TICKS, 0.001),
        driver_age_s=np.full(TICKS, 0.004),
        state=np.full(TICKS, TcsState.ACTIVE, np.uint8),
        fault_code=np.zeros(TICKS, np.uint8),
        failed=np.zeros(TICKS, np.bool_),
    )


def troubled(state: TcsState, code: int, begin: int, end: int) -> Record:
    """As ``calm``, but in ``state`` for ``code`` from tick ``begin`` up to ``end``."""
    record = calm()
    record.state[begin:end] = state
    record.fault_code[begin:end] = code
    if state is TcsState.FAULT:
        record.wanted_nm[begin:end] = math.nan
    return record
