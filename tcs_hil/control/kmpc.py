"""The Koopman MPC, step by step as the paper writes it: lift, gradient, box QP, first input."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.condense import DenseForm, condense, extend
from tcs_hil.control.integrator import SlipErrorIntegral
from tcs_hil.control.protocol import Proposal, SolveStatus, WheelState
from tcs_hil.control.qp import BoxSolution, OsqpBox
from tcs_hil.control.screening import clamp, settled
from tcs_hil.control.settings import ControlSettings, KmpcSettings
from tcs_hil.errors import ConfigError
from tcs_hil.model.predictor import KoopmanPredictor

FloatArray = NDArray[np.float64]


class KoopmanMpc:
    """One wheel's Koopman MPC, Eq. (opt_LTI), over N inputs u_0..u_{N-1}.

    Inputs are in the predictor's unit: torque in standard deviations from its
    mean.  Raises ConfigError for a predictor made for another period.
    """

    def __init__(self, settings: ControlSettings, predictor: KoopmanPredictor) -> None:
        if predictor.period_s != settings.period_s:
            raise ConfigError(
                f"period_s is {settings.period_s}, "
                f"but the predictor was identified for {predictor.period_s}"
            )
        self._predictor = predictor
        self._slip_reference = settings.slip_reference
        self._horizon = settings.kmpc.horizon
        self._two_w_u = 2.0 * settings.kmpc.weight_reduction
        dense = condense(extend(predictor), self._horizon)
        hessian, self._gradient_of_state = quadratic_cost(dense, settings.kmpc)
        self._qp = OsqpBox(hessian)
        self._integral = SlipErrorIntegral(settings.slip_reference, settings.period_s)
        self._lower = np.full(self._horizon, predictor.scale_input(0.0))  # (N,), zero torque

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        """Propose the motor torque for the coming period."""
        trivial = settled(wheel, torque_ref_nm)
        if trivial is not None:
            return trivial
        z = self._predictor.lift(wheel.slip_speed_mps, wheel.wheel_speed_radps)  # (nz,)
        xi = np.concatenate((z, (self._integral.value_s, self._slip_reference)))  # (nz + 2,)
        torque_ref = self._predictor.scale_input(torque_ref_nm)
        gradient = self._gradient_of_state @ xi - self._two_w_u * torque_ref  # (N,)
        plan = self._qp.solve(gradient, self._lower, np.full(self._horizon, torque_ref))
        proposal = self._first_input(plan, torque_ref_nm)
        self._integral.advance(wheel.slip_ratio, proposal.torque_nm, torque_ref_nm)
        return proposal

    def reset(self) -> None:
        """Forget the integral and the last plan."""
        self._integral.reset()
        self._qp.reset()

    def _first_input(self, plan: BoxSolution, torque_ref_nm: float) -> Proposal:
        if plan.status is SolveStatus.FAILED:
            self._qp.reset()
            return Proposal(torque_ref_nm, plan.status, plan.iterations)
        scaling = self._predictor.scaling
        torque_nm = scaling.torque_mean_nm + scaling.torque_std_nm * float(plan.x[0])
        return Proposal(clamp(torque_nm, torque_ref_nm), plan.status, plan.iterations)


def quadratic_cost(dense: DenseForm, weights: KmpcSettings) -> tuple[FloatArray, FloatArray]:
    """Hessian (N, N) and the map (N, nz + 2) from xi_0 to the gradient at U = 0.

    The cost is the sum over the horizon of w_p (kappa_ref - kappa)² + w_i e_int²
    + w_u (T_ref - u)²; the part of the gradient that comes from T_ref is left out.
    """
    w_p, w_i, w_u = weights.weight_slip, weights.weight_integral, weights.weight_reduction
    q = np.array([[w_p, 0.0, -w_p], [0.0, w_i, 0.0], [-w_p, 0.0, w_p]])  # on [kappa, e_int, ref]
    weighted = dense.theta.T @ np.kron(np.eye(weights.horizon), q)  # (N, 3 N)
    hessian = 2.0 * (weighted @ dense.theta + w_u * np.eye(weights.horizon))
    return hessian, 2.0 * weighted @ dense.gamma
