"""The core of the default nonlinear MPC in Python: CasADi's functions and the SQP."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.driveline_core import Disturbance
from tcs_hil.control.driveline_transcription import NX, advance_function, plan_function
from tcs_hil.control.least_squares import Linearisation
from tcs_hil.control.plan import Plan
from tcs_hil.control.settings import ControlSettings
from tcs_hil.control.sqp import minimise
from tcs_hil.model.vehicle import Vehicle

FloatArray = NDArray[np.float64]


class CasadiCore:
    """Gauss-Newton SQP, warm from the last plan, shifted by the period that has passed."""

    def __init__(self, settings: ControlSettings, vehicle: Vehicle) -> None:
        tuning = settings.default.nmpc
        self._flow = Flow(advance_function(settings, vehicle))
        self._problem = Linearisation(plan_function(settings, vehicle))
        self._patience = tuning
        self._period_s = settings.period_s
        self._guess = np.zeros(len(tuning.blocks))  # (N,), Nm
        self.x = np.zeros(NX)

    def start_from(self, x: Sequence[float]) -> None:
        """Set x (7,)."""
        self.x[:] = x

    def roll_forward(
        self, torques_nm: Sequence[float], first_periods: float, disturbance: Disturbance
    ) -> None:
        """Carry x through torques, the first for a part of a period, then one each."""
        duration_s = first_periods * self._period_s
        for torque_nm in torques_nm:
            self.x[:] = self._flow.after(self.x, torque_nm, duration_s, disturbance)
            duration_s = self._period_s

    def plan(
        self,
        last_torque_nm: float,
        torque_ref_nm: float,
        disturbance: Disturbance,
        urgency: float,
    ) -> Plan:
        """Best torques (N,) in Nm from x on."""
        self._problem.start_from(self.x, torque_ref_nm, last_torque_nm, *disturbance, urgency)
        feasible = np.minimum(self._guess, torque_ref_nm)
        plan = minimise(self._problem, feasible, torque_ref_nm, self._patience)
        self._guess = np.append(plan.inputs[1:], plan.inputs[-1])
        return plan

    def reset(self) -> None:
        """Forget the last plan."""
        self._guess = np.zeros_like(self._guess)
        self._problem.shrinkage = 1.0


class Flow:
    """The prediction model on preallocated memory."""

    def __init__(self, function: Any) -> None:
        self._x, self._parameters, self._after = np.zeros(NX), np.zeros(4), np.zeros(NX)
        self._buffer, self._evaluate = function.buffer()
        self._buffer.set_arg(0, self._x.data)
        self._buffer.set_arg(1, self._parameters.data)
        self._buffer.set_res(0, self._after.data)

    def after(
        self, state: FloatArray, torque_nm: float, duration_s: float, disturbance: Disturbance
    ) -> FloatArray:
        """State (7,) after a duration; valid until the next call."""
        self._x[:] = state
        self._parameters[:] = torque_nm, duration_s, *disturbance
        self._evaluate()
        return self._after
