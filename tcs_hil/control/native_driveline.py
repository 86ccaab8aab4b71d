"""The core of the default nonlinear MPC in C; residuals are those of `driveline_transcription`."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from msgspec.structs import astuple
from numpy.typing import NDArray

from tcs_hil.control.driveline_core import Situation
from tcs_hil.control.native_law import unpack_outcome
from tcs_hil.control.plan import Plan
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.native import array_of, core

FloatArray = NDArray[np.float64]


class NativeDriveline:
    """State and plan live in the memory of the C struct."""

    def __init__(self, settings: ControlSettings, vehicle: Vehicle) -> None:
        self._lib, self._struct = core().lib, core().ffi.new("driveline *")
        self._x = array_of(self._struct.x)  # (7,)
        _describe(self._struct, settings, vehicle)
        tuning = settings.default.nmpc
        self._plan = array_of(self._struct.plan)[: len(tuning.blocks)]  # (N,), Nm
        self._lib.driveline_setup(self._struct, len(tuning.blocks), tuning.max_iterations)

    def after(
        self, state: FloatArray, torque_nm: float, duration_s: float, disturbance_n: float
    ) -> FloatArray:
        """State (7,) after a duration; valid until the next call."""
        self._x[:] = state
        self._struct.disturbance_n = disturbance_n
        self._lib.driveline_advance(self._struct, torque_nm, duration_s)
        return self._x

    def plan(self, state: FloatArray, situation: Situation) -> Plan:
        """Best torques (N,) in Nm from a state (7,) on; valid until the next call."""
        torque_ref_nm, last_torque_nm, disturbance_n, urgency = situation
        self._x[:] = state
        self._struct.disturbance_n = disturbance_n
        outcome = self._lib.driveline_plan(self._struct, last_torque_nm, torque_ref_nm, urgency)
        return Plan(self._plan, *unpack_outcome(outcome))

    def reset(self) -> None:
        """Forget the last plan."""
        self._lib.driveline_reset(self._struct)


def _describe(struct: Any, settings: ControlSettings, vehicle: Vehicle) -> None:
    tuning = settings.default.nmpc
    struct.slip_gain, struct.integral_gain, struct.reduction_gain = (
        math.sqrt(weight / tuning.weight_change)
        for weight in (tuning.weight_slip, tuning.weight_integral, tuning.weight_reduction)
    )
    struct.period_s = settings.period_s
    struct.blocks[0 : len(tuning.blocks)] = tuning.blocks
    line, car = astuple(settings.default.driveline), astuple(vehicle)
    struct.parameters = (settings.slip_reference, *line, *car)
