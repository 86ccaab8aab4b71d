"""What an optimiser hands back: the whole input sequence and how it came about."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.protocol import SolveStatus

FloatArray = NDArray[np.float64]


class Plan(NamedTuple):
    """Inputs u_0..u_{N-1}; to be trusted unless the status is ``FAILED``.

    After ``MAX_ITERATIONS`` they lie in the box and are the best so far.
    """

    inputs: FloatArray  # (N,)
    status: SolveStatus
    iterations: int

    @property
    def next_nm(self) -> float:
        """Torque meant for the period after the coming one, NaN after ``FAILED``.

        A horizon of one means the same torque again.
        """
        failed = self.status is SolveStatus.FAILED
        return math.nan if failed else float(self.inputs[:2][-1])
