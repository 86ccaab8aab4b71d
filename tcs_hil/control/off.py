"""No control: the driver's request passes through."""

from __future__ import annotations

from tcs_hil.control.protocol import Proposal, WheelState
from tcs_hil.control.screening import settled


class OffController:
    """The yardstick of every comparison: never reduces the driver's torque."""

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        """Propose exactly what the driver asks."""
        return settled(wheel, torque_ref_nm) or Proposal(torque_ref_nm)

    def reset(self) -> None:
        """Nothing to forget."""
