"""Box-constrained QP with a constant Hessian on OSQP: set up once, vectors updated per solve."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import osqp
from numpy.typing import NDArray
from scipy import sparse

from tcs_hil.control.protocol import SolveStatus

FloatArray = NDArray[np.float64]

TOLERANCE = 1e-7
MAX_ITERATIONS = 4000
CHECK_EVERY = 5
_STATUS = {
    int(osqp.SolverStatus.OSQP_SOLVED): SolveStatus.OK,
    int(osqp.SolverStatus.OSQP_MAX_ITER_REACHED): SolveStatus.MAX_ITERATIONS,
}


class BoxSolution(NamedTuple):
    """Minimiser of one problem; meaningless when the status is ``FAILED``."""

    x: FloatArray  # (n,)
    status: SolveStatus
    iterations: int


class OsqpBox:
    """Minimise x'Hx/2 + g'x over lower <= x <= upper, H (n, n) positive definite.

    Three choices make OSQP both exact and quick here.  The objective is scaled
    to a largest eigenvalue of 1, because the tolerances are absolute.  The
    penalty is fixed at the geometric mean of the extreme eigenvalues, near the
    best for ADMM, so that no run depends on an earlier one's adaptation.  And
    the box is open at set-up: equal bounds would fix a penalty for equalities.
    """

    def __init__(self, hessian: FloatArray) -> None:
        eigenvalues = np.linalg.eigvalsh(hessian)
        self._scale = 1.0 / float(eigenvalues[-1])
        self._n = len(hessian)
        self._solver = self._set_up(
            hessian * self._scale, math.sqrt(float(eigenvalues[0]) * self._scale)
        )

    def _set_up(self, scaled_hessian: FloatArray, penalty: float) -> Any:
        problem = osqp.OSQP(algebra="builtin")
        problem.setup(
            P=sparse.csc_matrix(np.triu(scaled_hessian)),
            q=np.zeros(self._n),
            A=sparse.csc_matrix(np.eye(self._n)),
            l=np.full(self._n, -np.inf),
            u=np.full(self._n, np.inf),
            rho=penalty,
            adaptive_rho=False,
            scaling=0,
            eps_abs=TOLERANCE,
            eps_rel=0.0,
            max_iter=MAX_ITERATIONS,
            check_termination=CHECK_EVERY,
            verbose=False,
        )
        # The compiled solver behind the public class: the same calls without the
        # wrapper's copies of every result, which cost twice the solve itself.
        return problem._solver

    def solve(self, gradient: FloatArray, lower: FloatArray, upper: FloatArray) -> BoxSolution:
        """Solve for g, lower, upper (n,), warm from the last solution, which moves little.

        The returned ``x`` lies in the box up to ``TOLERANCE``.  Nothing is raised:
        a problem that is not finite, or a solver in trouble, is ``FAILED``.
        """
        if not np.isfinite(gradient).all():
            return BoxSolution(gradient, SolveStatus.FAILED, 0)
        if (lower == upper).all():
            return BoxSolution(lower, SolveStatus.OK, 0)
        self._solver.update_data_vec(q=gradient * self._scale, l=lower, u=upper)
        self._solver.solve()
        info = self._solver.info
        status = _STATUS.get(info.status_val, SolveStatus.FAILED)
        return BoxSolution(self._solver.solution.x, status, info.iter)

    def reset(self) -> None:
        """Forget the last solution: the next solve starts cold."""
        self._solver.warm_start(x=np.zeros(self._n), y=np.zeros(self._n))
