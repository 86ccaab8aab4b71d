"""The core of the default nonlinear MPC in C; residuals are those of `driveline_transcription`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from msgspec.structs import astuple

from tcs_hil.control.driveline_core import Disturbance
from tcs_hil.control.native_law import plan_of
from tcs_hil.control.plan import Plan
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.native import array_of, core


class NativeDriveline:
    """State and plan live in the memory of the C struct."""

    def __init__(self, settings: ControlSettings, vehicle: Vehicle) -> None:
        self._lib, self._struct = core().lib, core().ffi.new("driveline *")
        self.x = array_of(self._struct.x)  # (7,)
        _describe(self._struct, settings, vehicle)
        tuning = settings.default.nmpc
        self._plan = array_of(self._struct.plan)[: len(tuning.blocks)]  # (N,), Nm
        patience = tuning.max_iterations, tuning.leftover_nm
        self._lib.driveline_setup(self._struct, len(tuning.blocks), *patience)

    def start_from(self, x: Sequence[float]) -> None:
        """Set x (7,)."""
        self._struct.x = x  # a quarter of the time that numpy takes

    def roll_forward(
        self, torques_nm: Sequence[float], first_periods: float, disturbance: Disturbance
    ) -> None:
        """Carry x through torques, the first for a part of a period, then one each."""
        self._lib.driveline_roll_forward(
            self._struct, torques_nm, len(torques_nm), first_periods, *disturbance
        )

    def plan(
        self,
        last_torque_nm: float,
        torque_ref_nm: float,
        disturbance: Disturbance,
        urgency: float,
    ) -> Plan:
        """Best torques (N,) in Nm from x on; valid until the next call."""
        outcome = self._lib.driveline_plan(
            self._struct, last_torque_nm, torque_ref_nm, *disturbance, urgency
        )
        return plan_of(self._plan, outcome)

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
