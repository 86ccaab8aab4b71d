"""Measures how long a control law thinks, from outside: the law itself knows no clock."""

from __future__ import annotations

from tcs_hil.control.protocol import Controller, Proposal, WheelState
from tcs_hil.runtime.clock import Clock


class TimedController:
    """A controller that also adds up the time its steps took."""

    def __init__(self, controller: Controller, clock: Clock) -> None:
        self._controller = controller
        self._clock = clock
        self._spent_ns = 0

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        """Let the controller propose, and time it."""
        begin_ns = self._clock.now_ns()
        proposal = self._controller.step(wheel, torque_ref_nm)
        self._spent_ns += self._clock.now_ns() - begin_ns
        return proposal

    def reset(self) -> None:
        """Reset the controller."""
        self._controller.reset()

    def lap_ns(self) -> int:
        """Return the time spent since the last call: zero where the tick did not ask the law."""
        spent_ns, self._spent_ns = self._spent_ns, 0
        return spent_ns
