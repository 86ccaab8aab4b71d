"""The Koopman MPC as published, in C: what it needs to know is written into its struct."""

from __future__ import annotations

from typing import Any

from tcs_hil.control.condense import condense, extend
from tcs_hil.control.koopman_cost import quadratic_cost, require_period
from tcs_hil.control.native_law import NativeLaw
from tcs_hil.control.settings import ControlSettings
from tcs_hil.errors import ConfigError
from tcs_hil.model.predictor import KoopmanPredictor
from tcs_hil.native import core, doubles


def native_koopman_mpc(settings: ControlSettings, predictor: KoopmanPredictor) -> NativeLaw:
    """One wheel's KMPC.

    Raises ConfigError for a predictor made for another period, or weights that make
    the problem singular to machine precision.
    """
    require_period(settings, predictor)
    tuning = settings.kmpc
    hessian, gradient_map = quadratic_cost(condense(extend(predictor), tuning.horizon), tuning)
    law = NativeLaw("kmpc", settings)
    _describe(law.struct, predictor)
    law.struct.reduction_pull = 2.0 * tuning.weight_reduction
    if core().lib.kmpc_setup(law.struct, tuning.horizon, doubles(hessian), doubles(gradient_map)):
        raise ConfigError("the weights of kmpc make its problem singular: raise weight_reduction")
    return law


def _describe(struct: Any, predictor: KoopmanPredictor) -> None:
    """Write the lifting and the scaling of the torque."""
    provenance, scaling, car = predictor.provenance, predictor.scaling, predictor.provenance.vehicle
    struct.torque_mean_nm, struct.torque_std_nm = scaling.torque_mean_nm, scaling.torque_std_nm
    dictionary = provenance.dictionary.upper().replace("-", "_")
    lifting = struct.map
    lifting.dictionary = getattr(core().lib, dictionary)
    lifting.order, lifting.centre_count = provenance.order, len(provenance.centres)
    for row, centre in zip(lifting.centres, provenance.centres, strict=False):
        row[0], row[1] = centre
    lifting.s_mean_mps, lifting.s_std_mps = scaling.s_mean_mps, scaling.s_std_mps
    lifting.omega_mean_radps = scaling.omega_mean_radps
    lifting.omega_std_radps = scaling.omega_std_radps
    lifting.wheel_radius_m = car.wheel_radius_m
    lifting.slip_epsilon_m2ps2 = car.slip_epsilon_m2ps2
