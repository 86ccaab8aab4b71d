"""Box-constrained QP with a constant Hessian: OSQP finds the active bounds, they the solution."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import osqp
from numpy.typing import NDArray
from scipy import sparse

from tcs_hil.control.active_set import ActiveSets, Sides
from tcs_hil.control.plan import Plan
from tcs_hil.control.protocol import SolveStatus

FloatArray = NDArray[np.float64]

TOLERANCE = 1e-7
MAX_ITERATIONS = 4000
CHECK_EVERY = 5
CORRECTIONS = 8
_STATUS = {
    int(osqp.SolverStatus.OSQP_SOLVED): SolveStatus.OK,
    int(osqp.SolverStatus.OSQP_MAX_ITER_REACHED): SolveStatus.MAX_ITERATIONS,
}


class OsqpBox:
    """Minimise x'Hx/2 + g'x over lower <= x_i <= upper, H (n, n) positive definite.

    The active bounds of the last solution are tried first: they rarely change
    from tick to tick, and while they hold the solution takes one product of a
    matrix.  When they change OSQP finds the new ones.  Either way the result is
    the one that belongs to the active bounds, exact to rounding; only where OSQP
    leaves them in doubt it is OSQP's own.

    Four choices make OSQP both exact and quick here.  The objective is scaled
    to a largest eigenvalue of 1, because the tolerances are absolute.  The
    penalty is fixed at the geometric mean of the extreme eigenvalues, near the
    best for ADMM, so that no solve depends on how an earlier one adapted it.
    The box is open at set-up: equal bounds would choose the penalty of equality
    constraints.  And the gradient is clipped where it has decided: in a box of
    radius r no |(Hx)_i| exceeds sqrt(n) r, so a larger |g_i| pins x_i to its
    bound however large it is, while one of 1e9 (the lifted state far outside
    its data) would drown the tolerance in rounding.
    """

    def __init__(
        self,
        hessian: FloatArray,
        max_iterations: int = MAX_ITERATIONS,
        tolerance: float = TOLERANCE,
    ) -> None:
        eigenvalues = np.linalg.eigvalsh(hessian)
        self._scale = 1.0 / float(eigenvalues[-1])
        self._lower = np.zeros(len(hessian))
        self._upper = np.zeros(len(hessian))
        penalty = math.sqrt(float(eigenvalues[0]) * self._scale)
        self._decided = 2.0 * math.sqrt(len(hessian))  # per unit of radius, with a margin of 2
        self._solver = _compiled_solver(hessian * self._scale, penalty, max_iterations, tolerance)
        self._active_sets = ActiveSets(hessian, self._scale)

    def solve(self, gradient: FloatArray, lower: float, upper: float) -> Plan:
        """Solve for g (n,), warm from the last solution, which moves little between ticks.

        The result lies in the box up to the tolerance.  Nothing is raised: a
        problem that is not finite, or a solver in trouble, is ``FAILED``.
        """
        if not math.isfinite(float(gradient.dot(gradient)) + lower + upper):
            return Plan(gradient, SolveStatus.FAILED, 0)
        inputs = self._active_sets.solve(gradient, lower, upper)
        if inputs is not None:
            return Plan(inputs, SolveStatus.OK, 0)
        if lower == upper:
            return Plan(np.full_like(gradient, lower), SolveStatus.OK, 0)
        return self._search(gradient, lower, upper)

    def reset(self) -> None:
        """Forget the last solution: the next solve starts cold."""
        cold = np.zeros(len(self._lower))
        self._solver.warm_start(x=cold, y=cold)
        self._active_sets.assume(None)

    def _search(self, gradient: FloatArray, lower: float, upper: float) -> Plan:
        """Solve by OSQP, then by the active bounds it has found."""
        self._lower.fill(lower)
        self._upper.fill(upper)
        limit = self._decided * max(abs(lower), abs(upper))
        scaled = np.clip(gradient * self._scale, -limit, limit)
        self._solver.update_data_vec(q=scaled, l=self._lower, u=self._upper)
        self._solver.solve()
        info, inputs = self._solver.info, self._solver.solution.x
        status = _STATUS.get(info.status_val, SolveStatus.FAILED)
        if status is SolveStatus.OK:
            exact = self._exact(gradient, lower, upper)
            inputs = inputs if exact is None else exact
        return Plan(inputs, status, info.iter)

    def _exact(self, gradient: FloatArray, lower: float, upper: float) -> FloatArray | None:
        """Solution by the active bounds OSQP has found; its tolerance may have confused a few."""
        self._active_sets.assume(self._found_sides(lower, upper))
        for _ in range(CORRECTIONS):
            exact = self._active_sets.solve(gradient, lower, upper)
            if exact is not None:
                return exact
            self._active_sets.correct()
        return None

    def _found_sides(self, lower: float, upper: float) -> Sides:
        """A bound is active where its multiplier is larger than the distance to it."""
        x, y = self._solver.solution.x, self._solver.solution.y
        return tuple(((upper - x < y).astype(int) - (x - lower < -y)).tolist())


def _compiled_solver(
    scaled_hessian: FloatArray, penalty: float, max_iterations: int, tolerance: float
) -> Any:
    """The compiled solver behind ``osqp.OSQP``, set up with an open box.

    It takes the same calls as the public class without that class's copy of
    every result field, which costs twice the solve itself.
    """
    n = len(scaled_hessian)
    problem = osqp.OSQP(algebra="builtin")
    problem.setup(
        P=sparse.csc_matrix(np.triu(scaled_hessian)),
        q=np.zeros(n),
        A=sparse.csc_matrix(np.eye(n)),
        l=np.full(n, -np.inf),
        u=np.full(n, np.inf),
        rho=penalty,
        adaptive_rho=False,
        scaling=0,
        eps_abs=tolerance,
        eps_rel=0.0,
        max_iter=max_iterations,
        check_termination=CHECK_EVERY,
        verbose=False,
    )
    return problem._solver
