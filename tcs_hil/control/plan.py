"""What an optimiser hands back: the whole input sequence and how it came about."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.protocol import SolveStatus

FloatArray = NDArray[np.float64]


class Plan:
    """Inputs u_0..u_{N-1}; to be trusted unless the status is ``FAILED``.

    After ``MAX_ITERATIONS`` they lie in the box and are the best so far.
    """

    def __init__(self, inputs: FloatArray, status: SolveStatus, iterations: int) -> None:
        self.inputs: Final = inputs  # (N,)
        self.status: Final = status
        self.iterations: Final = iterations

    @property
    def next_nm(self) -> float:
        """Torque meant for the period after the coming one; the same of a horizon of one."""
        return self.inputs.item(min(1, self.inputs.size - 1))


def mixed(plans: Sequence[Plan], weights: Sequence[float]) -> Plan:
    """Weighted mean of plans; as bad as the worst of them, as long as all together."""
    inputs = sum(weight * plan.inputs for plan, weight in zip(plans, weights, strict=True))
    status = max((plan.status for plan in plans), default=SolveStatus.FAILED)
    return Plan(np.asarray(inputs), status, sum(plan.iterations for plan in plans))
