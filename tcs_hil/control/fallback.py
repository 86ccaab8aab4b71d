"""A law, and who decides in its place when it cannot: its own last plan, then a PI."""

from __future__ import annotations

import math
from typing import Final

from tcs_hil.control.pi import PiController
from tcs_hil.control.protocol import Controller, Proposal, Source, WheelState
from tcs_hil.control.screening import BAD_INPUT, FAILED, clamp, decided

LAST_PLAN: Final = Source.LAST_PLAN
FALLBACK: Final = Source.FALLBACK


class FallbackController:
    """The law as long as it decides; after a failed solve what it had planned, once; then the PI.

    The PI takes on every decision of the others, so it goes on from their last
    one.  A stand-in's proposal keeps the law's status and names its ``source``.
    Against bad input nothing stands in: the PI would know no more.
    """

    def __init__(self, law: Controller, fallback: PiController) -> None:
        self._law = law
        self._fallback = fallback
        self._planned_nm = math.nan

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        """Propose the motor torque for the coming period."""
        proposal = self._law.step(wheel, torque_ref_nm)
        planned_nm, self._planned_nm = self._planned_nm, proposal.next_nm
        if proposal.status is BAD_INPUT:
            return proposal
        if not decided(proposal):
            self._planned_nm = math.nan
            proposal = self._stand_in(proposal, planned_nm, wheel, torque_ref_nm)
        if proposal.source is not FALLBACK:
            self._fallback.follow(wheel, proposal.torque_nm, torque_ref_nm)
        return proposal

    def reset(self) -> None:
        """Forget everything, as at start-up."""
        self._law.reset()
        self._fallback.reset()
        self._planned_nm = math.nan

    def _stand_in(
        self, failed: Proposal, planned_nm: float, wheel: WheelState, torque_ref_nm: float
    ) -> Proposal:
        if math.isfinite(planned_nm):
            torque_nm, source = clamp(planned_nm, torque_ref_nm), LAST_PLAN
        else:
            torque_nm, source = self._fallback.step(wheel, torque_ref_nm).torque_nm, FALLBACK
        return Proposal(torque_nm, FAILED, failed.iterations, source=source)
