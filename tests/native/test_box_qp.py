"""The native box QP: against daqp on a hundred thousand problems, OSQP and IPOPT on some."""

from __future__ import annotations

from typing import Any

import casadi as ca
import daqp
import numpy as np
import osqp
import pytest
from scipy import sparse

from tcs_hil.native import core
from tests.native.boxes import Batch, NativeBox, random_batch

BATCHES = ((1, 4000), (2, 10_000), (5, 40_000), (6, 20_000), (10, 16_000), (16, 8_000), (40, 2_000))
"""Size and number of problems: 100 000 in all, most of them as large as the laws' own."""

CONDITIONS = (1.0, 30.0, 1e3, 1e5)


def solved_by_daqp(batch: Batch) -> np.ndarray:
    """Solutions (m, n); daqp's tolerances are absolute, and set where rounding is."""
    n, nothing = len(batch.hessian), np.empty((0, len(batch.hessian)))
    free = np.zeros(n, dtype=np.int32)
    x = np.empty_like(batch.gradient)
    for row, (g, lower, upper) in enumerate(
        zip(batch.gradient, batch.lower, batch.upper, strict=True)
    ):
        x[row], _, flag, _ = daqp.solve(
            batch.hessian, g, nothing, upper, lower, free, primal_tol=1e-11, eps_prox=0.0
        )
        assert flag == 1
    return x


def shortfall(batch: Batch, x: np.ndarray) -> float:
    """How far solutions (m, n) in the box are from Karush, Kuhn and Tucker's conditions."""
    assert ((batch.lower <= x) & (x <= batch.upper)).all()
    slope = x @ batch.hessian + batch.gradient
    size = np.abs(batch.gradient).sum(axis=1, keepdims=True) + 1.0
    may_rise, may_fall = x < batch.upper, x > batch.lower
    falling, rising = np.where(may_rise, -slope, 0.0), np.where(may_fall, slope, 0.0)
    return float((np.maximum(falling, rising) / size).max())


@pytest.mark.parametrize(("n", "count"), BATCHES)
def test_random_problems_meet_the_optimality_conditions_and_daqp(n: int, count: int) -> None:
    rng = np.random.default_rng(n)
    parts = 4 * len(CONDITIONS)
    for part in range(parts):
        condition = CONDITIONS[part % len(CONDITIONS)]
        batch = random_batch(rng, n, condition, count // parts)
        solver = NativeBox(batch.hessian)
        x = solver.solve_all(batch)
        assert shortfall(batch, x) < 1e-14
        # What daqp is from the optimum itself, at worst: its tolerance in the flattest direction.
        error = np.abs(x - solved_by_daqp(batch)).max(axis=1)
        assert (error <= 1e-10 * condition * (1.0 + np.abs(batch.gradient).max(axis=1))).all()


def by_osqp(batch: Batch, row: int) -> np.ndarray:
    n, problem = len(batch.hessian), osqp.OSQP()
    problem.setup(
        sparse.csc_matrix(np.triu(batch.hessian)),
        batch.gradient[row],
        sparse.csc_matrix(np.eye(n)),
        batch.lower[row],
        batch.upper[row],
        eps_abs=1e-10,
        eps_rel=0.0,
        max_iter=100_000,
        verbose=False,
    )
    return np.asarray(problem.solve(raise_error=False).x)


@pytest.fixture(scope="module")
def ipopt() -> Any:
    x, g, h = ca.SX.sym("x", 5), ca.SX.sym("g", 5), ca.SX.sym("h", 5, 5)
    cost = ca.mtimes([x.T, h, x]) / 2 + g.T @ x
    options = {"print_level": 0, "sb": "yes", "tol": 1e-11, "bound_relax_factor": 0.0}
    nlp = {"x": x, "p": ca.horzcat(h, g), "f": cost}
    return ca.nlpsol("box", "ipopt", nlp, {"ipopt": options, "print_time": False})


def test_osqp_and_ipopt_find_the_same_points(ipopt: Any) -> None:
    rng = np.random.default_rng(0)
    for _ in range(40):
        batch = random_batch(rng, 5, 30.0, 1)
        (x,) = NativeBox(batch.hessian).solve_all(batch)
        np.testing.assert_allclose(by_osqp(batch, 0), x, atol=1e-7, rtol=0)
        answer = ipopt(
            p=np.column_stack((batch.hessian, batch.gradient[0])),
            lbx=batch.lower[0],
            ubx=batch.upper[0],
        )
        # An interior point stays this far from the corner.
        np.testing.assert_allclose(np.asarray(answer["x"]).ravel(), x, atol=1e-4, rtol=0)


def test_the_answer_does_not_depend_on_where_the_solver_starts() -> None:
    batch = random_batch(np.random.default_rng(1), 10, 1e3, 300)
    warm, cold = NativeBox(batch.hessian), NativeBox(batch.hessian)
    for row, x in enumerate(warm.solve_all(batch)):
        cold.reset()
        again = cold.solve(batch.gradient[row], batch.lower[row], batch.upper[row])
        np.testing.assert_allclose(again, x, atol=1e-11, rtol=1e-11)


def test_a_box_of_one_point_is_answered_and_does_no_harm() -> None:
    solver = NativeBox(np.eye(3) + 0.5)
    corner = np.array([-1.0, 2.0, 0.0])
    assert (solver.solve(np.ones(3), corner, corner) == corner).all()
    opened = solver.solve(np.zeros(3), np.full(3, -5.0), np.full(3, 5.0))
    np.testing.assert_allclose(opened, 0.0, atol=1e-15)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_what_is_not_finite_fails_and_leaves_the_solver_usable(bad: float) -> None:
    solver = NativeBox(np.eye(2))
    arrays = [np.zeros(2), np.full(2, -1.0), np.full(2, 1.0)]
    for place in range(3):
        spoilt = [array.copy() for array in arrays]
        spoilt[place][1] = bad
        with pytest.raises(AssertionError):
            solver.solve(*spoilt)
        solver.reset()
        assert (solver.solve(*arrays) == 0.0).all()


@pytest.mark.parametrize(
    "hessian", [np.zeros((2, 2)), np.array([[1.0, 2.0], [2.0, 1.0]]), np.full((2, 2), np.nan)]
)
def test_a_hessian_that_is_not_positive_definite_is_refused(hessian: np.ndarray) -> None:
    assert NativeBox(hessian).set_up_status == core().lib.SOLVE_FAILED


def test_more_variables_than_there_is_room_for_are_refused() -> None:
    assert NativeBox(np.eye(41)).set_up_status == core().lib.SOLVE_FAILED
