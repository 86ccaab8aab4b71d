"""The paper's Koopman problem handed to general QP solvers, through what they offer everybody."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import daqp
import numpy as np
import osqp
from numpy.typing import NDArray
from scipy import sparse

from tcs_hil.control.kmpc import BoxQp, KoopmanOptimiser
from tcs_hil.control.plan import Plan
from tcs_hil.control.protocol import SolveStatus
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.predictor import KoopmanPredictor, default_model_path

FloatArray = NDArray[np.float64]

OSQP_TOLERANCE = 1e-6


class OsqpPublic:
    """OSQP as its documentation shows it: ``update``, ``solve``, warm by itself."""

    def __init__(self, hessian: FloatArray) -> None:
        n = len(hessian)
        # Brought to a norm of 1: OSQP's tolerances are absolute.
        self._scale = 1.0 / float(np.linalg.norm(hessian, 2))
        self._problem = osqp.OSQP()
        self._problem.setup(
            P=sparse.csc_matrix(np.triu(hessian * self._scale)),
            q=np.zeros(n),
            A=sparse.csc_matrix(np.eye(n)),
            l=np.full(n, -np.inf),
            u=np.full(n, np.inf),
            eps_abs=OSQP_TOLERANCE,
            eps_rel=0.0,
            verbose=False,
        )

    def solve(self, gradient: FloatArray, lower: float, upper: float) -> Plan:
        """Solve for g (n,) and the two bounds of every variable."""
        n = len(gradient)
        bounds = {"l": np.full(n, lower), "u": np.full(n, upper)}
        self._problem.update(q=gradient * self._scale, **bounds)
        result = self._problem.solve(raise_error=False)
        return Plan(np.array(result.x), SolveStatus.OK, result.info.iter)

    def reset(self) -> None:
        """It goes on from where it was."""


class DaqpModel:
    """daqp through its reusable model."""

    def __init__(self, hessian: FloatArray) -> None:
        n = len(hessian)
        self._model: Any = daqp.Model()
        nothing, bound = np.empty((0, n)), np.ones(n)
        sense = np.zeros(n, dtype=np.int32)
        self._model.setup(np.ascontiguousarray(hessian), np.zeros(n), nothing, bound, -bound, sense)

    def solve(self, gradient: FloatArray, lower: float, upper: float) -> Plan:
        """Solve for g (n,) and the two bounds of every variable."""
        n = len(gradient)
        self._model.update(f=gradient, bupper=np.full(n, upper), blower=np.full(n, lower))
        inputs, _, _, info = self._model.solve()
        return Plan(inputs, SolveStatus.OK, info["iterations"])

    def reset(self) -> None:
        """It goes on from where it was."""


def optimiser(settings: ControlSettings, box_qp: Callable[[FloatArray], BoxQp]) -> KoopmanOptimiser:
    """The published Koopman MPC with the shipped predictor and one of these solvers."""
    predictor = KoopmanPredictor.load(default_model_path(), settings.period_s)
    return KoopmanOptimiser(predictor, settings.kmpc, settings.slip_reference, box_qp)
