"""OSQP's box QP against daqp, an exact active-set solver."""

from __future__ import annotations

from itertools import product

import daqp
import numpy as np
import pytest

from tcs_hil.control.protocol import SolveStatus
from tcs_hil.control.qp import OsqpBox

N = 5


def random_hessian(rng: np.random.Generator, condition: float) -> np.ndarray:
    """Positive definite (N, N) with the largest eigenvalue of a condensed KMPC, about 1e-3."""
    basis, _ = np.linalg.qr(rng.normal(size=(N, N)))
    return (basis * np.geomspace(1e-3 / condition, 1e-3, N)) @ basis.T


def exact(hessian: np.ndarray, gradient: np.ndarray, lower: float, upper: float) -> np.ndarray:
    scale = 1.0 / np.linalg.eigvalsh(hessian)[0]  # daqp's tolerances are absolute too
    bounds = np.full(N, upper), np.full(N, lower)
    free = np.zeros(N, dtype=np.int32)
    x, _, flag, _ = daqp.solve(hessian * scale, gradient * scale, np.empty((0, N)), *bounds, free)
    assert flag == 1
    return x


def enumerated(hessian: np.ndarray, gradient: np.ndarray) -> np.ndarray:
    """Minimiser over [-3, 4]^N by trying every set of active bounds: slow, and beyond doubt."""
    for pattern in product((None, -3.0, 4.0), repeat=N):
        free = np.array([bound is None for bound in pattern])
        x = np.array([0.0 if bound is None else bound for bound in pattern])
        rhs = -(gradient + hessian @ x)
        x[free] = np.linalg.solve(hessian[np.ix_(free, free)], rhs[free])
        slope = gradient + hessian @ x
        inside = ((x >= -3.0) & (x <= 4.0)).all()
        if inside and (slope[x == -3.0] >= 0).all() and (slope[x == 4.0] <= 0).all():
            return x
    raise AssertionError("a strictly convex QP has a minimiser")


@pytest.mark.parametrize("condition", [1.0, 12.0, 300.0])
def test_random_problems_are_solved_like_an_active_set_solver(condition: float) -> None:
    rng = np.random.default_rng(7)
    hessian = random_hessian(rng, condition)
    qp = OsqpBox(hessian)
    for _ in range(200):
        gradient = hessian @ rng.normal(scale=4.0, size=N)
        lower, upper = -3.0, -3.0 + rng.uniform(1e-6, 7.0)
        plan = qp.solve(gradient, lower, upper)
        assert plan.status is SolveStatus.OK
        # The stationarity OSQP stops at allows this much in the flattest direction.
        allowed = 10 * 1e-7 * condition
        np.testing.assert_allclose(
            plan.inputs, exact(hessian, gradient, lower, upper), atol=allowed, rtol=0
        )


@pytest.mark.parametrize("size", [1e2, 1e6, 1e12])
def test_a_huge_gradient_is_solved_as_exactly_and_as_quickly(size: float) -> None:
    rng = np.random.default_rng(5)
    hessian = random_hessian(rng, 12.0)
    qp = OsqpBox(hessian)
    for _ in range(50):
        # One input is decided by far, the others are not.
        gradient = hessian @ rng.normal(scale=2.0, size=N)
        gradient[rng.integers(N)] = rng.choice([-size, size]) * 1e-3
        plan = qp.solve(gradient, -3.0, 4.0)
        assert plan.status is SolveStatus.OK
        assert plan.iterations <= 100
        np.testing.assert_allclose(plan.inputs, enumerated(hessian, gradient), atol=1e-5)


def test_a_box_of_one_point_is_answered_without_the_solver_and_does_no_harm() -> None:
    rng = np.random.default_rng(3)
    hessian = random_hessian(rng, 12.0)
    gradient = hessian @ np.array([1.0, -1.0, 0.5, 2.0, -4.0])
    qp = OsqpBox(hessian)
    pinned = qp.solve(gradient, -3.0, -3.0)
    assert (pinned.inputs == -3.0).all()
    assert pinned.iterations == 0
    opened = qp.solve(gradient, -3.0, 4.0)
    np.testing.assert_allclose(opened.inputs, exact(hessian, gradient, -3.0, 4.0), atol=1e-5)


def test_a_gradient_that_is_not_finite_fails_and_leaves_the_solver_usable() -> None:
    hessian = random_hessian(np.random.default_rng(3), 12.0)
    gradient = np.full(N, 1e-3)
    qp = OsqpBox(hessian)
    for bad in (np.nan, np.inf):
        assert qp.solve(gradient * bad, -3.0, 4.0).status is SolveStatus.FAILED
    plan = qp.solve(gradient, -3.0, 4.0)
    assert plan.status is SolveStatus.OK
    np.testing.assert_allclose(plan.inputs, exact(hessian, gradient, -3.0, 4.0), atol=1e-5)


def test_running_out_of_iterations_is_a_status() -> None:
    hessian = random_hessian(np.random.default_rng(3), 300.0)
    plan = OsqpBox(hessian, max_iterations=5).solve(np.full(N, 1e-3), -3.0, 4.0)
    assert plan.status is SolveStatus.MAX_ITERATIONS


def test_after_a_reset_a_solve_repeats_the_first_one_bit_for_bit() -> None:
    hessian = random_hessian(np.random.default_rng(3), 12.0)
    qp = OsqpBox(hessian)
    cold = qp.solve(np.full(N, 1e-3), -3.0, 4.0)
    qp.reset()
    again = qp.solve(np.full(N, 1e-3), -3.0, 4.0)
    assert (again.inputs == cold.inputs).all()
    assert again.iterations == cold.iterations > 0
