"""A law within its validity and a fallback outside, handed over without a bump."""

from __future__ import annotations

from typing import Final

from tcs_hil.control.protocol import Controller, Proposal, WheelState
from tcs_hil.model.provenance import Validity

HAND_OVER_S: Final = 0.05


class GuardedController:
    """The law while the vehicle's speed is one its model knows, else the fallback.

    Both decide in every tick; what is proposed moves from one to the other in
    50 ms.  A speed that strays over the border and back therefore costs nothing.
    Slip and torque need no guard: beyond the slip of the data a linear predictor
    overrates it, and the answer is the lower bound of the torque, which is right.
    """

    def __init__(
        self, law: Controller, fallback: Controller, validity: Validity, period_s: float
    ) -> None:
        self._law = law
        self._fallback = fallback
        self._low_mps, self._high_mps = validity.speed_mps
        self._pace = period_s / HAND_OVER_S
        self._trust = 1.0

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        """Propose the motor torque for the coming period."""
        law = self._law.step(wheel, torque_ref_nm)
        fallback = self._fallback.step(wheel, torque_ref_nm)
        valid = self._low_mps <= wheel.vehicle_speed_mps <= self._high_mps
        self._trust += self._pace if valid else -self._pace
        self._trust = min(max(self._trust, 0.0), 1.0)
        return _between(fallback, law, self._trust)

    def reset(self) -> None:
        """Forget everything, as at start-up."""
        self._law.reset()
        self._fallback.reset()
        self._trust = 1.0


def _between(fallback: Proposal, law: Proposal, trust: float) -> Proposal:
    """Mixed torque; status and iterations of the one that has more say."""
    if trust == 1.0:
        return law
    if trust == 0.0:
        return fallback
    torque_nm = fallback.torque_nm + trust * (law.torque_nm - fallback.torque_nm)
    major = law if trust >= 0.5 else fallback
    return Proposal(torque_nm, major.status, major.iterations)
