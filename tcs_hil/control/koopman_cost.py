"""The cost of the published Koopman MPC as a quadratic function of the scaled torques."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.condense import DenseForm
from tcs_hil.control.settings import ControlSettings, KmpcSettings
from tcs_hil.errors import ConfigError
from tcs_hil.model.predictor import KoopmanPredictor

FloatArray = NDArray[np.float64]


def require_period(settings: ControlSettings, predictor: KoopmanPredictor) -> None:
    """Raise ConfigError for a predictor made for another period."""
    if predictor.period_s != settings.period_s:
        raise ConfigError(
            f"period_s is {settings.period_s}, but the predictor is for {predictor.period_s}"
        )


def quadratic_cost(dense: DenseForm, tuning: KmpcSettings) -> tuple[FloatArray, FloatArray]:
    """Hessian (N, N) of the cost, and the map (N, nz + 2) from xi_0 to its gradient at U = 0.

    The cost is the sum over the horizon of w_p (kappa_ref - kappa)² + w_i e_int²
    + w_u (T_ref - u)².  T_ref is no part of xi_0: its pull on the gradient,
    -2 w_u T_ref on every input, is the caller's to add.
    """
    w_p, w_i, w_u = tuning.weight_slip, tuning.weight_integral, tuning.weight_reduction
    q = np.array([[w_p, 0.0, -w_p], [0.0, w_i, 0.0], [-w_p, 0.0, w_p]])  # on [kappa, e_int, ref]
    weighted = dense.theta.T @ np.kron(np.eye(tuning.horizon), q)  # (N, 3 N)
    hessian = 2.0 * (weighted @ dense.theta + w_u * np.eye(tuning.horizon))
    return hessian, 2.0 * weighted @ dense.gamma
