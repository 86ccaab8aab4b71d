"""What the default Koopman MPC leaves to C where that was built: prediction and plan."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.backend import chosen_backend
from tcs_hil.control.plan import Plan
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.bank import KoopmanBank, Share
from tcs_hil.signals import ControllerKind

FloatArray = NDArray[np.float64]


class BankCore(Protocol):
    """The bands around a speed over x of `bank_problem`; arrays are valid until the next call."""

    def settle(self, shares: Sequence[Share]) -> None:
        """From now on these one or two bands predict and plan, mixed by weight."""
        ...

    def wheel_speed_after(self, state: FloatArray) -> float:
        """Wheel speed in rad/s one period after a state (NX,), without torque or disturbance."""
        ...

    def after(self, state: FloatArray, torque_nm: float, periods: float) -> FloatArray:
        """State (NX,) after ``periods`` in (0, 1] periods of a torque; linear within a period."""
        ...

    def plan(self, state: FloatArray, last_torque_nm: float, torque_ref_nm: float) -> Plan:
        """Best torques (N,) in Nm within [0, torque_ref_nm] from a state (NX,) on."""
        ...

    def reset(self) -> None:
        """Forget the last plans."""
        ...


def bank_core(settings: ControlSettings, bank: KoopmanBank) -> BankCore:
    """One wheel's; OSQP is imported where it is used."""
    if chosen_backend(ControllerKind.KMPC, settings) == "native":
        from tcs_hil.control.native_bank import NativeBank  # noqa: PLC0415

        return NativeBank(settings, bank)
    from tcs_hil.control.bank_osqp import OsqpBank  # noqa: PLC0415

    return OsqpBank(settings, bank)
