"""What both default laws share: the state rolled through the delay, then planned from."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, Protocol

from tcs_hil.control.break_away import BreakAway
from tcs_hil.control.entry import Entry
from tcs_hil.control.integrator import BoundedIntegral
from tcs_hil.control.plan import Plan
from tcs_hil.control.protocol import Proposal, WheelState
from tcs_hil.control.screening import FAILED, clamp, settled
from tcs_hil.control.sent import SentTorques
from tcs_hil.control.swing_guard import SwingGuard


class DelayedOptimiser(Protocol):
    """A law that plans from the state of its own prediction model, in these three steps."""

    def observe(self, wheel: WheelState, integral_s: float) -> None:
        """The state is the one at the instant ``wheel`` describes; called once a tick."""
        ...

    def roll_forward(self, torques_nm: Sequence[float], first_periods: float) -> None:
        """Carry the state through torques, the first for a part of a period, then one each."""
        ...

    def plan(self, last_torque_nm: float, torque_ref_nm: float) -> Plan:
        """Torques in Nm within [0, torque_ref_nm] from the state on, after ``last_torque_nm``."""
        ...

    def reset(self) -> None:
        """Forget the last plan and everything estimated."""
        ...


GIVEN_BACK_NM: Final = 1.0

SHORT_DELAY_S: Final = 0.007
"""Behind a longer one the integral counts less: as quick as on a short loop, it swings."""


class CompensatedController:
    """Receding horizon from the state at which the command will act.

    ``wheel.loop_delay_s`` says how long that is after the instant of the
    measurement; the prediction model carries the state, e_int with it, through
    the torques already sent.  With an ``entry`` the driver decides until it is
    passed, and again once the law has given all torque back.  ``break_away``
    bounds the torque of a law that cannot catch every wheel by itself.
    While ``swing_guard`` holds, nobody decides: the torque is the ceiling.
    """

    def __init__(
        self,
        optimiser: DelayedOptimiser,
        integral: BoundedIntegral,
        swing_guard: SwingGuard,
        period_s: float,
        break_away: BreakAway | None = None,
        entry: Entry | None = None,
    ) -> None:
        self._optimiser = optimiser
        self._integral = integral
        self._break_away = break_away
        self._swing_guard = swing_guard
        self._period_s = period_s
        self._entry = entry
        self._begun = self._awake = False
        self._sent = SentTorques()
        self._proposed_nm = 0.0  # what was sent, where the estimator does not tell

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        """Propose the motor torque for the coming period."""
        if self._begun:  # a law that begins does so from no torque, and catches a wheel that spins
            known = -math.inf < wheel.sent_nm < math.inf
            self._sent.push(wheel.sent_nm if known else self._proposed_nm)
        self._begun = True
        proposal = settled(wheel, torque_ref_nm) or self._solve(wheel, torque_ref_nm)
        self._proposed_nm = clamp(proposal.torque_nm, max(torque_ref_nm, 0.0))
        return proposal

    def reset(self) -> None:
        """Forget everything, as at start-up."""
        self._integral.reset()
        self._optimiser.reset()
        self._swing_guard.reset()
        if self._break_away:
            self._break_away.reset()
        self._sent.reset()
        self._begun = self._awake = False

    def _solve(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        self._optimiser.observe(wheel, self._weighed_integral_s(wheel.loop_delay_s))
        self._optimiser.roll_forward(*self._sent.pending(wheel.loop_delay_s / self._period_s))
        ceiling_nm = self._ceiling_nm(wheel, torque_ref_nm)
        plan = self._optimiser.plan(self._sent.newest_nm, ceiling_nm)
        if plan.status is FAILED:
            self._optimiser.reset()  # what failed is no warm start
            return Proposal(torque_ref_nm, plan.status, plan.iterations)
        torque_nm = self._entered(wheel, clamp(plan.inputs.item(0), ceiling_nm), ceiling_nm)
        torque_nm = ceiling_nm if self._swing_guard.holds else torque_nm
        self._integral.advance(wheel.slip_ratio, torque_nm, ceiling_nm)
        return Proposal(torque_nm, plan.status, plan.iterations, plan.next_nm)

    def _ceiling_nm(self, wheel: WheelState, torque_ref_nm: float) -> float:
        sent_nm = self._sent.newest_nm
        ceiling_nm = self._swing_guard.ceiling_nm(wheel, torque_ref_nm, sent_nm)
        if self._break_away is None:
            return ceiling_nm
        return min(ceiling_nm, self._break_away.ceiling_nm(wheel, torque_ref_nm, sent_nm))

    def _entered(self, wheel: WheelState, torque_nm: float, ceiling_nm: float) -> float:
        """``torque_nm`` from the entry on until all is given back, else ``ceiling_nm``."""
        slips = self._entry is None or self._entry.passed(wheel)
        self._awake = slips or (self._awake and torque_nm < ceiling_nm - GIVEN_BACK_NM)
        return torque_nm if self._awake else ceiling_nm

    def _weighed_integral_s(self, delay_s: float) -> float:
        share = min(SHORT_DELAY_S / max(delay_s, SHORT_DELAY_S), 1.0)
        return share * share * self._integral.value_s
