"""What both predictive laws share: screening, integral state, first input, failure policy."""

from __future__ import annotations

from typing import Protocol

from tcs_hil.control.integrator import SlipErrorIntegral
from tcs_hil.control.plan import Plan
from tcs_hil.control.protocol import Proposal, SolveStatus, WheelState
from tcs_hil.control.screening import clamp, settled


class Optimiser(Protocol):
    """The law itself: the best torque sequence from one measured state."""

    def plan(self, wheel: WheelState, integral_s: float, torque_ref_nm: float) -> Plan:
        """Torques in Nm within [0, torque_ref_nm], which is positive and held over the horizon."""
        ...

    def reset(self) -> None:
        """Forget the last plan."""
        ...


class PredictiveController:
    """Receding horizon: plan, apply the first input, advance the integral."""

    def __init__(self, optimiser: Optimiser, integral: SlipErrorIntegral) -> None:
        self._optimiser = optimiser
        self._integral = integral

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        """Propose the motor torque for the coming period."""
        trivial = settled(wheel, torque_ref_nm)
        if trivial is not None:
            return trivial
        plan = self._optimiser.plan(wheel, self._integral.value_s, torque_ref_nm)
        if plan.status is SolveStatus.FAILED:
            self._optimiser.reset()  # what failed is no warm start
            return Proposal(torque_ref_nm, plan.status, plan.iterations)
        torque_nm = clamp(plan.inputs.item(0), torque_ref_nm)
        self._integral.advance(wheel.slip_ratio, torque_nm, torque_ref_nm)
        return Proposal(torque_nm, plan.status, plan.iterations, plan.next_nm)

    def reset(self) -> None:
        """Forget the integral and the last plan, as at start-up."""
        self._integral.reset()
        self._optimiser.reset()
