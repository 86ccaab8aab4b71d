"""What the default nonlinear MPC leaves to C where that was built: prediction and plan."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.backend import chosen_backend
from tcs_hil.control.plan import Plan
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.signals import ControllerKind

FloatArray = NDArray[np.float64]


class Situation(NamedTuple):
    """What a plan depends on beside the state it starts from."""

    torque_ref_nm: float
    last_torque_nm: float
    disturbance_n: float  # on the tyre force
    urgency: float  # factor on the residuals of slip and integral


class DrivelineCore(Protocol):
    """The prediction model, and the optimisation over it; arrays are valid until the next call."""

    def after(
        self, state: FloatArray, torque_nm: float, duration_s: float, disturbance_n: float
    ) -> FloatArray:
        """State (7,) after a duration of at most 4 ms under a commanded motor torque."""
        ...

    def plan(self, state: FloatArray, situation: Situation) -> Plan:
        """Best torques (N,) in Nm from a state (7,) on, warm from the last plan."""
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
