"""What both predictive laws do around their optimiser."""

from __future__ import annotations

import numpy as np

from tcs_hil.control.integrator import SlipErrorIntegral
from tcs_hil.control.plan import Plan
from tcs_hil.control.predictive import PredictiveController
from tcs_hil.control.protocol import Proposal, SolveStatus, WheelState
from tests.control.recorder import wheel_at

WHEEL = wheel_at(5.0, 0.3)


class Scripted:
    """An optimiser that answers from a list."""

    def __init__(self, *plans: Plan) -> None:
        self._plans = list(plans)
        self.integrals: list[float] = []
        self.resets = 0

    def plan(self, wheel: WheelState, integral_s: float, torque_ref_nm: float) -> Plan:
        self.integrals.append(integral_s)
        return self._plans.pop(0)

    def reset(self) -> None:
        self.resets += 1


def plan(first_nm: float, status: SolveStatus = SolveStatus.OK) -> Plan:
    return Plan(np.array([first_nm, 1.0, 2.0]), status, 3)


def control(optimiser: Scripted) -> PredictiveController:
    return PredictiveController(optimiser, SlipErrorIntegral(0.1, 0.002))


def test_the_first_input_of_the_plan_is_proposed() -> None:
    assert control(Scripted(plan(80.0))).step(WHEEL, 200.0) == Proposal(
        80.0, iterations=3, next_nm=1.0
    )


def test_a_solver_tolerance_never_leaves_the_box() -> None:
    controller = control(Scripted(plan(200.0 + 1e-7), plan(-1e-7)))
    assert controller.step(WHEEL, 200.0).torque_nm == 200.0
    assert controller.step(WHEEL, 200.0).torque_nm == 0.0


def test_the_best_plan_so_far_is_used_when_iterations_run_out() -> None:
    proposal = control(Scripted(plan(80.0, SolveStatus.MAX_ITERATIONS))).step(WHEEL, 200.0)
    assert proposal == Proposal(80.0, SolveStatus.MAX_ITERATIONS, 3, 1.0)


def test_a_failed_solve_leaves_the_request_and_is_no_warm_start() -> None:
    optimiser = Scripted(plan(np.nan, SolveStatus.FAILED), plan(80.0))
    controller = control(optimiser)
    assert controller.step(WHEEL, 200.0) == Proposal(200.0, SolveStatus.FAILED, 3)
    assert optimiser.resets == 1
    controller.step(WHEEL, 200.0)
    assert optimiser.integrals == [0.0, 0.0]  # the law was not in charge


def test_the_integral_reaches_the_next_solve_and_reset_clears_it() -> None:
    optimiser = Scripted(plan(80.0), plan(80.0), plan(80.0))
    controller = control(optimiser)
    controller.step(WHEEL, 200.0)
    controller.step(WHEEL, 200.0)
    controller.reset()
    controller.step(WHEEL, 200.0)
    step = 0.002 * (0.1 - WHEEL.slip_ratio)
    assert optimiser.integrals == [0.0, step, 0.0]
    assert optimiser.resets == 1
