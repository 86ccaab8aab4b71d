"""The Koopman MPC, step by step as the paper writes it: lift, gradient, box QP."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.condense import condense, extend
from tcs_hil.control.integrator import SlipErrorIntegral
from tcs_hil.control.koopman_cost import quadratic_cost, require_period
from tcs_hil.control.plan import Plan
from tcs_hil.control.predictive import PredictiveController
from tcs_hil.control.protocol import WheelState
from tcs_hil.control.qp import OsqpBox
from tcs_hil.control.settings import ControlSettings, KmpcSettings
from tcs_hil.model.predictor import KoopmanPredictor

FloatArray = NDArray[np.float64]


class BoxQp(Protocol):
    """Solves box QPs that share a Hessian, as ``OsqpBox`` does."""

    def solve(self, gradient: FloatArray, lower: float, upper: float) -> Plan:
        """Solve for g (n,) and the two bounds of every variable."""
        ...

    def reset(self) -> None:
        """Forget the last solution."""
        ...


class KoopmanOptimiser:
    """The quadratic program of Eq. (opt_LTI) over the scaled torques U = [u_0 .. u_{N-1}].

    ``box_qp`` makes its solver from the Hessian (N, N).
    """

    def __init__(
        self,
        predictor: KoopmanPredictor,
        tuning: KmpcSettings,
        slip_reference: float,
        box_qp: Callable[[FloatArray], BoxQp] = OsqpBox,
    ) -> None:
        self._lifting, self._scaling = predictor.lifting, predictor.scaling
        self._slip_reference = slip_reference
        dense = condense(extend(predictor), tuning.horizon)
        hessian, gradient_map = quadratic_cost(dense, tuning)
        reduction_pull = np.full(len(hessian), 2.0 * tuning.weight_reduction)
        self._gradient_map = np.column_stack((gradient_map, -reduction_pull))  # (N, nz + 3)
        self._qp = box_qp(hessian)
        self._zero_torque = float(self._scaling.scale_torque(0.0))

    def plan(self, wheel: WheelState, integral_s: float, torque_ref_nm: float) -> Plan:
        """Best torques (N,) in Nm within [0, torque_ref_nm]."""
        z = self._lifting.observables(wheel.slip_speed_mps, wheel.wheel_speed_radps)
        torque_ref = self._scaling.scale_torque(torque_ref_nm)
        gradient = self._gradient_map.dot(  # (N,)
            np.array((*z, integral_s, self._slip_reference, torque_ref))
        )
        plan = self._qp.solve(gradient, self._zero_torque, torque_ref)
        return Plan(self._in_nm(plan.inputs), plan.status, plan.iterations)

    def reset(self) -> None:
        """Forget the last plan."""
        self._qp.reset()

    def _in_nm(self, scaled_torques: FloatArray) -> FloatArray:
        return scaled_torques * self._scaling.torque_std_nm + self._scaling.torque_mean_nm


def koopman_mpc(settings: ControlSettings, predictor: KoopmanPredictor) -> PredictiveController:
    """One wheel's KMPC.  Raises ConfigError for a predictor made for another period."""
    require_period(settings, predictor)
    return PredictiveController(
        KoopmanOptimiser(predictor, settings.kmpc, settings.slip_reference),
        SlipErrorIntegral(settings.slip_reference, settings.period_s),
    )
