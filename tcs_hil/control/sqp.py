"""Gauss-Newton SQP over a box: exact box QPs (daqp) and a backtracking line search."""

from __future__ import annotations

import math
from typing import Protocol

import daqp
import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.plan import Plan
from tcs_hil.control.protocol import SolveStatus

FloatArray = NDArray[np.float64]

STEP_TOLERANCE_NM = 1.5e-3
"""A step this small is taken and ends the iteration.

Along the paper's manoeuvres each iteration shrinks the error 180-fold or better
(the residuals at the solution are small), so what is left is below 1e-5 Nm.
"""

LEAST_SHRINKAGE = 5e-4
"""Steps are not trusted to shrink better: at a bound they shrink to nothing."""

ARMIJO = 1e-4
STEP_LENGTHS = tuple(0.5**k for k in range(16))


class LeastSquares(Protocol):
    """A sum of squares with its Gauss-Newton model at the last plan asked for."""

    plan: FloatArray  # (N,)
    gradient: FloatArray  # (N,)
    hessian: FloatArray  # (N, N), positive definite
    shrinkage: float  # a step over the one before it, when there last were two; 1 at first

    def at(self, plan: FloatArray) -> float:
        """Cost of a plan (N,)."""
        ...


class Patience(Protocol):
    """When to stop."""

    @property
    def max_iterations(self) -> int:
        """Linearisations of a tick."""
        ...

    @property
    def leftover_nm(self) -> float:
        """What the last step may leave, judged by how the steps of earlier ticks have shrunk."""
        ...


def expected(problem: LeastSquares, ceiling_nm: float) -> FloatArray:
    """Where the model has its minimum (N,) within 0 to ceiling_nm; zero if it has none."""
    step = _box_step(problem, problem.plan, ceiling_nm)
    return np.zeros_like(problem.plan) if step is None else problem.plan + step


def minimise(
    problem: LeastSquares, plan: FloatArray, ceiling_nm: float, patience: Patience
) -> Plan:
    """Minimise over 0 <= plan <= ceiling_nm from a feasible plan (N,).  Nothing is raised."""
    cost, before_nm = problem.at(plan), math.inf
    for iteration in range(1, patience.max_iterations + 1):
        step = _box_step(problem, plan, ceiling_nm) if math.isfinite(cost) else None
        if step is None:
            return Plan(plan, SolveStatus.FAILED, iteration)
        length_nm = max(map(abs, step.tolist()))
        if iteration > 1:
            problem.shrinkage = max(length_nm / before_nm, LEAST_SHRINKAGE)
        if _suffices(length_nm, problem.shrinkage, patience):
            return Plan(plan + step, SolveStatus.OK, iteration)
        (plan, cost), before_nm = _search(problem, plan, cost, step), length_nm
    return Plan(plan, SolveStatus.MAX_ITERATIONS, patience.max_iterations)


def _suffices(length_nm: float, shrinkage: float, patience: Patience) -> bool:
    """Is a step of this length the last one?"""
    return length_nm <= STEP_TOLERANCE_NM or length_nm * shrinkage <= patience.leftover_nm


def _box_step(problem: LeastSquares, plan: FloatArray, ceiling_nm: float) -> FloatArray | None:
    """Minimiser of the quadratic model within the box, as a step (N,); None if daqp gives up."""
    n = len(plan)
    step, _, exit_flag, _ = daqp.solve(
        problem.hessian,
        problem.gradient,
        np.empty((0, n)),
        ceiling_nm - plan,
        -plan,
        np.zeros(n, dtype=np.int32),
    )
    return step if exit_flag > 0 else None


def _search(
    problem: LeastSquares, plan: FloatArray, cost: float, step: FloatArray
) -> tuple[FloatArray, float]:
    """Go along the step until the cost falls enough (Armijo); the model follows the plan."""
    slope = ARMIJO * float(problem.gradient @ step)
    for length in STEP_LENGTHS:
        trial = plan + length * step
        trial_cost = problem.at(trial)
        if trial_cost <= cost + length * slope:
            break
    return trial, trial_cost
