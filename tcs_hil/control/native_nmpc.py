"""The nonlinear MPC as published, in C: what it needs to know is written into its struct."""

from __future__ import annotations

import math

from msgspec.structs import astuple

from tcs_hil.control.native_law import NativeLaw
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.native import core


def native_nonlinear_mpc(settings: ControlSettings, vehicle: Vehicle) -> NativeLaw:
    """One wheel's NMPC; residuals and their scale are those of `tcs_hil.control.transcription`."""
    tuning = settings.nmpc
    law = NativeLaw("nmpc", settings)
    struct = law.struct
    struct.substeps = tuning.substeps
    struct.slip_gain = math.sqrt(tuning.weight_slip / tuning.weight_reduction)
    struct.integral_gain = math.sqrt(tuning.weight_integral / tuning.weight_reduction)
    struct.parameters = (settings.slip_reference, *astuple(vehicle))
    patience = tuning.max_iterations, tuning.leftover_nm
    core().lib.nmpc_setup(struct, tuning.horizon, *patience)
    return law
