"""Answers that need no optimisation: what every law says to bad or empty input."""

from __future__ import annotations

import math
from typing import Final

from tcs_hil.control.protocol import Proposal, SolveStatus, WheelState
from tcs_hil.signals import NO_LIMIT

BEYOND_ANY_WHEEL: Final = 1e6
"""In any unit of a wheel's state: NaN and infinity fail it, and what passes cannot overflow."""

FAILED: Final = SolveStatus.FAILED
BAD_INPUT: Final = SolveStatus.BAD_INPUT
NOTHING_TO_GIVE: Final = Proposal(0.0)
UNUSABLE_REQUEST: Final = Proposal(NO_LIMIT, BAD_INPUT)


def settled(wheel: WheelState, torque_ref_nm: float) -> Proposal | None:
    """Proposal where there is nothing to optimise over [0, torque_ref_nm], else None.

    A request that is not a number cannot be handed back, so the proposal is
    ``NO_LIMIT``: not ours to judge.  A negative one (braking) and an unknown
    wheel leave the request as it is.  All three are ``BAD_INPUT``.
    """
    if not -math.inf < torque_ref_nm < math.inf:
        return UNUSABLE_REQUEST
    if torque_ref_nm < 0.0 or not _plausible(wheel):
        return Proposal(torque_ref_nm, BAD_INPUT)
    return NOTHING_TO_GIVE if torque_ref_nm == 0.0 else None


def decided(proposal: Proposal) -> bool:
    """Whether the law has made up its mind by itself."""
    undecided = proposal.status is FAILED or proposal.status is BAD_INPUT
    return not undecided and -math.inf < proposal.torque_nm < math.inf


def _plausible(wheel: WheelState) -> bool:
    return (
        -BEYOND_ANY_WHEEL < wheel.slip_speed_mps < BEYOND_ANY_WHEEL
        and -BEYOND_ANY_WHEEL < wheel.wheel_speed_radps < BEYOND_ANY_WHEEL
        and -BEYOND_ANY_WHEEL < wheel.slip_ratio < BEYOND_ANY_WHEEL
        and -BEYOND_ANY_WHEEL < wheel.vehicle_speed_mps < BEYOND_ANY_WHEEL
    )


def clamp(value: float, ceiling: float) -> float:
    """``value`` within [0, ceiling]."""
    return min(max(value, 0.0), ceiling)
