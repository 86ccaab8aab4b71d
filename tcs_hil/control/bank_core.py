"""What the default Koopman MPC leaves to C where that was built: prediction and plan."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.backend import chosen_backend
from tcs_hil.control.plan import Plan
from tcs_hil.control.protocol import WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.bank import KoopmanBank
from tcs_hil.signals import ControllerKind

FloatArray = NDArray[np.float64]


class BankCore(Protocol):
    """The state of `bank_problem`, and the one or two bands in charge of it, mixed by weight."""

    x: FloatArray  # (NX,), rolled forward and planned from

    def observe(
        self, wheel: WheelState, torque_nm: float, integral_s: float, disturbance_radps: float
    ) -> float:
        """Set x to what is seen now, with the bands around the vehicle's speed in charge.

        ``torque_nm`` is the motor's, as well as it is known.  Returns the wheel speed one
        period later, in rad/s, without torque or disturbance.
        """
        ...

    def roll_forward(self, torques_nm: Sequence[float], first_periods: float) -> None:
        """Carry x through torques, the first for a part of a period; linear within a period."""
        ...

    def plan(self, last_torque_nm: float, torque_ref_nm: float) -> Plan:
        """Best torques (N,) in Nm within [0, torque_ref_nm] from x on; valid until the next."""
        ...

    def reset(self) -> None:
        """Forget the last sample and the last plans."""
        ...


def bank_core(settings: ControlSettings, bank: KoopmanBank) -> BankCore:
    """One wheel's; OSQP is imported where it is used."""
    if chosen_backend(ControllerKind.KMPC, settings) == "native":
        from tcs_hil.control.native_bank import NativeBank  # noqa: PLC0415

        return NativeBank(settings, bank)
    from tcs_hil.control.bank_osqp import OsqpBank  # noqa: PLC0415

    return OsqpBank(settings, bank)
