"""The Koopman MPC, step by step as the paper writes it: lift, gradient, box QP."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.condense import DenseForm, condense, extend
from tcs_hil.control.integrator import SlipErrorIntegral
from tcs_hil.control.plan import Plan
from tcs_hil.control.predictive import PredictiveController
from tcs_hil.control.protocol import WheelState
from tcs_hil.control.qp import OsqpBox
from tcs_hil.control.settings import ControlSettings, KmpcSettings
from tcs_hil.errors import ConfigError
from tcs_hil.model.predictor import KoopmanPredictor

FloatArray = NDArray[np.float64]


class KoopmanOptimiser:
    """The quadratic program of Eq. (opt_LTI) over the scaled torques U = [u_0 .. u_{N-1}]."""

    def __init__(
        self, predictor: KoopmanPredictor, tuning: KmpcSettings, slip_reference: float
    ) -> None:
        self._predictor = predictor
        self._slip_reference = slip_reference
        self._reduction_pull = 2.0 * tuning.weight_reduction
        dense = condense(extend(predictor), tuning.horizon)
        hessian, self._gradient_map = quadratic_cost(dense, tuning)
        self._qp = OsqpBox(hessian)
        self._zero_torque = float(predictor.scale_input(0.0))

    def plan(self, wheel: WheelState, integral_s: float, torque_ref_nm: float) -> Plan:
        """Best torques (N,) in Nm within [0, torque_ref_nm]."""
        z = self._predictor.lift(wheel.slip_speed_mps, wheel.wheel_speed_radps)  # (nz,)
        xi = np.concatenate((z, (integral_s, self._slip_reference)))  # (nz + 2,)
        torque_ref = self._predictor.scale_input(torque_ref_nm)
        gradient = self._gradient_map @ xi - self._reduction_pull * torque_ref  # (N,)
        inputs, status, iterations = self._qp.solve(gradient, self._zero_torque, torque_ref)
        return Plan(self._in_nm(inputs), status, iterations)

    def reset(self) -> None:
        """Forget the last plan."""
        self._qp.reset()

    def _in_nm(self, scaled_torques: FloatArray) -> FloatArray:
        scaling = self._predictor.scaling
        return scaled_torques * scaling.torque_std_nm + scaling.torque_mean_nm


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


def koopman_mpc(settings: ControlSettings, predictor: KoopmanPredictor) -> PredictiveController:
    """One wheel's KMPC.  Raises ConfigError for a predictor made for another period."""
    if predictor.period_s != settings.period_s:
        raise ConfigError(
            f"period_s is {settings.period_s}, but the predictor is for {predictor.period_s}"
        )
    return PredictiveController(
        KoopmanOptimiser(predictor, settings.kmpc, settings.slip_reference),
        SlipErrorIntegral(settings.slip_reference, settings.period_s),
    )
