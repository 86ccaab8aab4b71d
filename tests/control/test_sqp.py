"""The SQP iteration on problems small enough to know the answer."""

from __future__ import annotations

import math

import numpy as np
import pytest
from msgspec.structs import replace

from tcs_hil.control.protocol import SolveStatus
from tcs_hil.control.settings import DrivelineNmpcSettings, NmpcSettings
from tcs_hil.control.sqp import expected, minimise

UNHURRIED = NmpcSettings()


class Arctangents:
    """Sum of (100 atan((x_i - target_i) / 10))²: full Gauss-Newton steps overshoot and diverge."""

    def __init__(self, target: list[float]) -> None:
        self._target = np.array(target)
        self.plan = np.zeros(2)
        self.shrinkage = 1.0
        self.evaluations = 0

    def at(self, plan: np.ndarray) -> float:
        self.evaluations += 1
        self.plan = plan
        distance = (plan - self._target) / 10.0
        residual, slope = 100.0 * np.arctan(distance), 10.0 / (1.0 + distance**2)
        self.gradient = 2.0 * slope * residual
        self.hessian = np.diag(2.0 * slope**2)
        return float(residual @ residual)


class Undefined:
    """A cost that is not a number."""

    plan, gradient, hessian, shrinkage = np.zeros(2), np.zeros(2), np.eye(2), 1.0

    def at(self, plan: np.ndarray) -> float:
        return math.nan


class Concave(Undefined):
    """A model no QP solver accepts."""

    hessian = -np.eye(2)

    def at(self, plan: np.ndarray) -> float:
        return 1.0


def test_the_line_search_tames_steps_that_would_diverge() -> None:
    plan = minimise(Arctangents([30.0, 70.0]), np.array([100.0, 0.0]), 100.0, UNHURRIED)
    assert plan.status is SolveStatus.OK
    np.testing.assert_allclose(plan.inputs, [30.0, 70.0], atol=1e-5)


def test_a_minimum_outside_the_box_is_met_at_the_bound() -> None:
    plan = minimise(Arctangents([-5.0, 12.0]), np.array([8.0, 2.0]), 10.0, UNHURRIED)
    np.testing.assert_allclose(plan.inputs, [0.0, 10.0], atol=1e-9)


def test_a_good_guess_costs_one_evaluation() -> None:
    problem = Arctangents([30.0, 70.0])
    plan = minimise(problem, np.array([30.0 + 5e-4, 70.0]), 100.0, UNHURRIED)
    assert plan.iterations == problem.evaluations == 1
    np.testing.assert_allclose(plan.inputs, [30.0, 70.0], atol=1e-9)


def test_once_steps_were_seen_to_shrink_one_that_leaves_little_is_the_last() -> None:
    problem, patience = Arctangents([30.0, 70.0]), DrivelineNmpcSettings()
    guess = np.array([29.5, 70.0])
    assert minimise(problem, guess, 100.0, patience).iterations == 2
    assert problem.shrinkage < 1e-2
    plan = minimise(problem, guess, 100.0, replace(patience, max_iterations=1))
    assert plan.status is SolveStatus.OK
    np.testing.assert_allclose(plan.inputs, [30.0, 70.0], atol=patience.leftover_nm)


def test_at_a_bound_steps_shrink_to_nothing_which_says_little() -> None:
    problem = Arctangents([-5.0, 12.0])
    minimise(problem, np.array([8.0, 2.0]), 10.0, UNHURRIED)
    assert problem.shrinkage > 0.0


def test_running_out_of_iterations_is_a_status_with_a_plan_in_the_box() -> None:
    plan = minimise(
        Arctangents([30.0, 70.0]),
        np.array([100.0, 0.0]),
        100.0,
        replace(UNHURRIED, max_iterations=2),
    )
    assert plan.status is SolveStatus.MAX_ITERATIONS
    assert ((plan.inputs >= 0.0) & (plan.inputs <= 100.0)).all()


@pytest.mark.parametrize("problem", [Undefined(), Concave()])
def test_a_problem_that_cannot_be_solved_is_a_status(problem: Undefined) -> None:
    assert minimise(problem, np.ones(2), 10.0, UNHURRIED).status is SolveStatus.FAILED


def test_what_the_model_expects_lies_in_the_box_and_asks_nothing_of_the_problem() -> None:
    problem = Arctangents([30.0, 70.0])
    problem.at(np.array([29.9, 69.9]))
    np.testing.assert_allclose(expected(problem, 50.0), [30.0, 50.0], atol=1e-4)
    assert problem.evaluations == 1


def test_a_model_without_a_minimum_expects_no_torque() -> None:
    np.testing.assert_array_equal(expected(Concave(), 10.0), [0.0, 0.0])
