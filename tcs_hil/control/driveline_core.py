"""What the default nonlinear MPC leaves to C where that was built: prediction and plan."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.backend import chosen_backend
from tcs_hil.control.plan import Plan
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.signals import ControllerKind

FloatArray = NDArray[np.float64]

Disturbance = tuple[float, float]


class DrivelineCore(Protocol):
    """The state of `driveline_transcription`, its prediction and the optimisation over it.

    A ``disturbance`` is (N, m/s²): added to the tyre's force, and to the body's acceleration.
    """

    x: FloatArray  # (7,), rolled forward and planned from

    def start_from(self, x: Sequence[float]) -> None:
        """Set x (7,)."""
        ...

    def roll_forward(
        self, torques_nm: Sequence[float], first_periods: float, disturbance: Disturbance
    ) -> None:
        """Carry x through torques, the first for a part of a period, then one each."""
        ...

    def plan(
        self,
        last_torque_nm: float,
        torque_ref_nm: float,
        disturbance: Disturbance,
        urgency: float,
    ) -> Plan:
        """Best torques (N,) in Nm from x on, warm from the last plan; valid until the next.

        ``urgency`` is a factor on the residuals of slip and integral.
        """
        ...

    def reset(self) -> None:
        """Forget the last plan."""
        ...


def driveline_core(settings: ControlSettings, vehicle: Vehicle) -> DrivelineCore:
    """One wheel's; CasADi is imported where it is used, and its first functions take a while."""
    if chosen_backend(ControllerKind.NMPC, settings) == "native":
        from tcs_hil.control.native_driveline import NativeDriveline  # noqa: PLC0415

        return NativeDriveline(settings, vehicle)
    from tcs_hil.control.driveline_casadi import CasadiCore  # noqa: PLC0415

    return CasadiCore(settings, vehicle)
