"""A law within its validity and a PI outside, handed over without a bump."""

from __future__ import annotations

import math
from typing import Final

from tcs_hil.control.pi import PiController
from tcs_hil.control.protocol import Controller, Proposal, WheelState
from tcs_hil.control.screening import decided
from tcs_hil.model.ranges import Range

HAND_OVER_S: Final = 0.05


class GuardedController:
    """The law while its model knows the vehicle's speed and sees the motor, else the PI.

    The PI takes on every decision of the law; once it has a say, both decide in
    every tick, and what is proposed moves from one to the other in 50 ms.  A speed
    that strays over the border and back therefore costs nothing.  Slip and torque
    need no guard: beyond the slip of the data a linear predictor overrates it, and
    the answer is the lower bound of the torque, which is right.
    """

    def __init__(
        self, law: Controller, fallback: PiController, speed_mps: Range, period_s: float
    ) -> None:
        self._law = law
        self._fallback = fallback
        self._low_mps, self._high_mps = speed_mps
        self._pace = period_s / HAND_OVER_S
        self._trust = 1.0
        self._mixed_nm = 0.0  # last proposed on the way back

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        """Propose the motor torque for the coming period."""
        law = self._law.step(wheel, torque_ref_nm)
        if not self._is_valid(wheel):
            return self._fall_back(wheel, torque_ref_nm)
        self._trust = min(self._trust + self._pace, 1.0)
        if self._trust == 1.0:
            if decided(law):
                self._fallback.follow(wheel, law.torque_nm, torque_ref_nm)
            return law
        mixed = _between(self._fallback.step(wheel, torque_ref_nm), law, self._trust)
        self._mixed_nm = mixed.torque_nm
        return mixed

    def reset(self) -> None:
        """Forget everything, as at start-up."""
        self._law.reset()
        self._fallback.reset()
        self._trust = 1.0

    def _fall_back(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        """The PI's decision, which goes on from the mix where the way back is broken off."""
        if 0.0 < self._trust < 1.0:
            self._fallback.follow(wheel, self._mixed_nm, torque_ref_nm)
        self._trust = 0.0
        return self._fallback.step(wheel, torque_ref_nm)

    def _is_valid(self, wheel: WheelState) -> bool:
        sees_motor = -math.inf < wheel.motor_torque_nm < math.inf
        return sees_motor and self._low_mps <= wheel.vehicle_speed_mps <= self._high_mps


def _between(fallback: Proposal, law: Proposal, trust: float) -> Proposal:
    """Mixed torque; status and iterations of the one that has more say."""
    torque_nm = fallback.torque_nm
    if decided(law):  # else its torque is the driver's request
        torque_nm += trust * (law.torque_nm - torque_nm)
    major = law if trust >= 0.5 else fallback
    return Proposal(torque_nm, major.status, major.iterations)
