"""The nonlinear MPC against IPOPT, which solves the paper's problem written another way."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np
import pytest

from tcs_hil.control.integrator import SlipErrorIntegral
from tcs_hil.control.least_squares import Tracked
from tcs_hil.control.nmpc import NonlinearOptimiser
from tcs_hil.control.predictive import PredictiveController
from tcs_hil.control.protocol import SolveStatus
from tcs_hil.control.settings import ControlSettings
from tcs_hil.control.transcription import gauss_newton_function
from tcs_hil.model.vehicle import Vehicle
from tests.control import quarter_car
from tests.control.quarter_car import PERIOD_S, drive
from tests.control.recorder import Recorder, wheel_at

HORIZON, SUBSTEPS, REFERENCE = 5, 4, 0.1
W_P, W_I, W_U = 1e3, 1e5, 1.6e-7
AGREEMENT_NM = 1e-5

Solve = Callable[[tuple[float, float, float], float], np.ndarray]


def _dynamics(x: Any, torque: Any) -> tuple[Any, Any]:
    """f_ocp(x, u) of the paper with the quarter mass, and kappa."""
    rim = x[1] * quarter_car.RADIUS_M
    kappa = x[0] * rim / (rim**2 + 0.1)
    shape = ca.sin(quarter_car.TYRE_C * ca.atan(quarter_car.TYRE_B * kappa))
    force = 0.3 * quarter_car.LOAD_N * quarter_car.TYRE_D * shape
    radius, inertia = quarter_car.RADIUS_M, quarter_car.INERTIA_KGM2
    wheel_torque = quarter_car.GEAR * torque
    s_rate = (
        -(radius**2 / inertia + 4.0 / quarter_car.MASS_KG) * force + radius / inertia * wheel_torque
    )
    omega_rate = (wheel_torque - force * radius) / inertia
    return ca.vertcat(s_rate, omega_rate, REFERENCE - kappa), kappa


def _period(x: Any, torque: Any) -> Any:
    h = PERIOD_S / SUBSTEPS
    for _ in range(SUBSTEPS):
        k1 = _dynamics(x, torque)[0]
        k2 = _dynamics(x + h * k1 / 2, torque)[0]
        k3 = _dynamics(x + h * k2 / 2, torque)[0]
        k4 = _dynamics(x + h * k3, torque)[0]
        x = x + h * (k1 / 6 + k2 / 3 + k3 / 3 + k4 / 6)
    return x


@pytest.fixture(scope="module")
def ipopt() -> Solve:
    return ipopt_reference(1e-8)


def ipopt_reference(tolerance: float) -> Solve:
    """Multiple shooting, exact Hessian, run to convergence from a start of its own."""
    x, u = ca.SX.sym("x", 3), ca.SX.sym("u")
    flow = ca.Function("flow", [x, u], [_period(x, u)])
    slip = ca.Function("slip", [x], [_dynamics(x, 0.0)[1]])
    states, torques = ca.SX.sym("X", 3, HORIZON), ca.SX.sym("U", HORIZON)
    start, request = ca.SX.sym("x0", 3), ca.SX.sym("T_ref")
    cost, gaps, previous = ca.SX(0), [], start
    for k in range(HORIZON):
        gaps.append(states[:, k] - flow(previous, torques[k]))
        previous = states[:, k]
        cost += W_P * (REFERENCE - slip(previous)) ** 2 + W_I * previous[2] ** 2
        cost += W_U * (request - torques[k]) ** 2
    problem = {
        "x": ca.vertcat(ca.vec(states), torques),
        "p": ca.vertcat(start, request),
        "f": cost / W_U,  # in Nm², so that IPOPT's absolute tolerance means something
        "g": ca.vertcat(*gaps),
    }
    quiet = {"print_level": 0, "sb": "yes", "tol": tolerance, "bound_relax_factor": 0.0}
    solver = ca.nlpsol("reference", "ipopt", problem, {"ipopt": quiet, "print_time": False})

    def solve(x0: tuple[float, float, float], torque_ref_nm: float) -> np.ndarray:
        guess = np.concatenate((np.tile(x0, HORIZON), np.full(HORIZON, torque_ref_nm / 2)))
        free = np.full(3 * HORIZON, np.inf)
        answer = solver(
            x0=guess,
            p=(*x0, torque_ref_nm),
            lbx=np.concatenate((-free, np.zeros(HORIZON))),
            ubx=np.concatenate((free, np.full(HORIZON, torque_ref_nm))),
            lbg=0.0,
            ubg=0.0,
        )
        assert solver.stats()["success"]
        return np.asarray(answer["x"]).ravel()[-HORIZON:]

    return solve


def _recorded_run(friction: Callable[[float], float], duration_s: float) -> Recorder:
    settings = ControlSettings()
    recorder = Recorder(NonlinearOptimiser(settings, Vehicle()))
    integral = SlipErrorIntegral(settings.slip_reference, settings.period_s)
    drive(PredictiveController(recorder, integral), friction, duration_s, 50.0)
    return recorder


@pytest.mark.parametrize(
    ("friction", "duration_s"),
    [(quarter_car.constant_friction, 3.0), (quarter_car.varying_friction, 8.0)],
)
def test_along_a_manoeuvre_the_plan_is_the_one_ipopt_converges_to(
    ipopt: Solve, friction: Callable[[float], float], duration_s: float
) -> None:
    calls = _recorded_run(friction, duration_s).calls[::15]
    for call in calls:
        x0 = (call.wheel.slip_speed_mps, call.wheel.wheel_speed_radps, call.integral_s)
        expected = ipopt(x0, call.torque_ref_nm)
        assert call.plan.status is SolveStatus.OK
        assert np.abs(call.plan.inputs - expected).max() < AGREEMENT_NM


def test_from_any_state_the_first_torque_is_the_one_ipopt_converges_to(ipopt: Solve) -> None:
    """Far from any closed loop Gauss-Newton contracts less well; 0.01 Nm is still no torque."""
    optimiser = NonlinearOptimiser(ControlSettings(), Vehicle())
    rng = np.random.default_rng(0)
    for _ in range(250):
        wheel = wheel_at(rng.uniform(0.3, 30.0), rng.uniform(-0.05, 0.9))
        torque_ref_nm, integral_s = rng.uniform(1.0, 250.0), rng.uniform(-0.01, 0.01)
        optimiser.reset()
        plan = optimiser.plan(wheel, integral_s, torque_ref_nm)
        x0 = (wheel.slip_speed_mps, wheel.wheel_speed_radps, integral_s)
        assert abs(plan.inputs[0] - ipopt(x0, torque_ref_nm)[0]) < 1e-2


def test_a_step_of_the_measured_speed_costs_one_linearisation() -> None:
    """The first torque answers one bit of the wheel speed by more than 1 Nm."""
    optimiser = NonlinearOptimiser(ControlSettings(), Vehicle())
    before = optimiser.plan(wheel_at(5.0, 0.1), 0.0, 200.0)
    after = optimiser.plan(wheel_at(5.0, 0.1004), 0.0, 200.0)
    assert abs(after.inputs[0] - before.inputs[0]) > 1.0
    assert before.iterations > after.iterations == 1


def test_the_gradient_follows_state_and_request_to_first_order() -> None:
    """At the reference and with all the torque asked for, Gauss-Newton leaves nothing out."""
    wheel, plan = wheel_at(5.0, 0.1), np.full(HORIZON, 135.3)
    given = np.array([wheel.slip_speed_mps, wheel.wheel_speed_radps, 0.0, plan[0]])
    change = np.array([1e-5, -2e-5, 3e-6, 2e-2])
    problem = Tracked(gauss_newton_function(ControlSettings(), Vehicle()))
    problem.start_from(given[:3], given[3])
    problem.at(plan)
    still = problem.gradient.copy()
    problem.start_from((given + change)[:3], (given + change)[3])
    followed = problem.gradient.copy()
    problem.at(plan)
    moved = np.abs(problem.gradient - still).min()
    assert np.abs(followed - problem.gradient).max() < 1e-2 * moved


def test_the_result_does_not_depend_on_the_warm_start() -> None:
    warm = NonlinearOptimiser(ControlSettings(), Vehicle())
    cold = NonlinearOptimiser(ControlSettings(), Vehicle())
    for kappa in np.linspace(0.02, 0.3, 15):
        wheel = wheel_at(5.0, float(kappa))
        cold.reset()
        difference = warm.plan(wheel, 0.0, 200.0).inputs - cold.plan(wheel, 0.0, 200.0).inputs
        assert np.abs(difference).max() < AGREEMENT_NM
