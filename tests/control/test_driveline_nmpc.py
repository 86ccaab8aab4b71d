"""The default nonlinear MPC: its model, its derivatives and its loop."""

from __future__ import annotations

import math

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.integrate import solve_ivp

from tcs_hil.control.driveline_casadi import Flow
from tcs_hil.control.driveline_nmpc import DrivelineOptimiser, driveline_mpc
from tcs_hil.control.driveline_transcription import advance_function, plan_function
from tcs_hil.control.force_disturbance import ForceDisturbance
from tcs_hil.control.least_squares import Linearisation
from tcs_hil.control.protocol import Proposal, SolveStatus, WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.tyre import tyre_force_n
from tcs_hil.model.vehicle import Vehicle
from tests.control.believed_car import chatter_nm, drive
from tests.control.recorder import wheel_at

SETTINGS, VEHICLE = ControlSettings(), Vehicle()
LINE, TUNING = SETTINGS.default.driveline, SETTINGS.default.nmpc
STATE = np.array([0.4, 8.0, 0.001, 90.0, 8.2, 0.05, 900.0])
REQUEST_NM, LAST_NM, URGENCY = 200.0, 95.0, 0.7
DISTURBANCE = DISTURBANCE_N, DISTURBANCE_MPS2 = -150.0, -0.8
UNDISTURBED = 0.0, 0.0


def rate(_: float, x: np.ndarray, torque_nm: float) -> list[float]:
    """The equations of the driveline, written down a second time."""
    s, omega, _, motor_nm, motor_omega, twist, force_n = x
    rim = 0.318 * omega
    kappa = s * rim / (rim * rim + 0.1)
    shaft_nm = 6000.0 * twist + 25.0 * (motor_omega - omega)
    omega_rate = (shaft_nm - 0.318 * force_n) / 0.95
    static_n = float(tyre_force_n(kappa, VEHICLE)) + DISTURBANCE_N
    relaxation_m = 0.07 + 0.05 / math.hypot(1.0, 1.3 * VEHICLE.tyre_b * kappa)
    return [
        0.318 * omega_rate - 2.0 / 1400.0 * force_n - DISTURBANCE_MPS2,
        omega_rate,
        0.1 - kappa,
        (torque_nm - motor_nm) / 0.005,
        (3.0 * motor_nm - shaft_nm) / 0.27,
        motor_omega - omega,
        (static_n - force_n) / (relaxation_m / math.hypot(rim, 1.5) + 0.0025),
    ]


def test_the_model_is_the_driveline_integrated() -> None:
    flow = Flow(advance_function(SETTINGS, VEHICLE))
    after = flow.after(STATE, 120.0, 0.002, DISTURBANCE)
    exact = solve_ivp(rate, (0.0, 0.002), STATE, args=(120.0,), rtol=1e-10, atol=1e-12).y[:, -1]
    np.testing.assert_allclose(after, exact, rtol=2e-4, atol=1e-6)


def test_the_state_is_carried_through_every_torque_under_way() -> None:
    flow, optimiser = (
        Flow(advance_function(SETTINGS, VEHICLE)),
        DrivelineOptimiser(SETTINGS, VEHICLE),
    )
    optimiser.state[:] = STATE
    optimiser.roll_forward([40.0, 60.0], 0.25)
    half = flow.after(STATE, 40.0, 0.25 * 0.002, UNDISTURBED).copy()
    whole = flow.after(half, 60.0, 0.002, UNDISTURBED)
    np.testing.assert_allclose(optimiser.state, whole, rtol=1e-12)


@pytest.mark.parametrize("speed_mps", [0.3, 60.0])
def test_one_runge_kutta_step_of_the_longest_block_is_stable(speed_mps: float) -> None:
    flow = Flow(advance_function(SETTINGS, VEHICLE))
    omega = speed_mps / VEHICLE.wheel_radius_m
    state = np.array([0.01, omega, 0.0, 0.0, omega, 0.0, 0.0])
    for _ in range(500):
        state = flow.after(state, 20.0, 0.004, UNDISTURBED).copy()
    assert np.abs(state).max() < 500.0
    assert state[6] == pytest.approx(3.0 * 20.0 / 0.318, rel=0.1)


@pytest.fixture
def problem() -> Linearisation:
    linearisation = Linearisation(plan_function(SETTINGS, VEHICLE))
    linearisation.start_from(STATE, REQUEST_NM, LAST_NM, *DISTURBANCE, URGENCY)
    return linearisation


def test_the_cost_is_the_weighted_sum_over_the_plan(problem: Linearisation) -> None:
    flow, x, last, cost = Flow(advance_function(SETTINGS, VEHICLE)), STATE, LAST_NM, 0.0
    plan = np.linspace(80.0, 120.0, len(TUNING.blocks))
    for torque_nm, periods in zip(plan, TUNING.blocks, strict=True):
        x = flow.after(x, torque_nm, periods * 0.002, DISTURBANCE).copy()
        rim = 0.318 * x[1]
        kappa = x[0] * rim / (rim * rim + 0.1)
        tracking = TUNING.weight_slip * (0.1 - kappa) ** 2 + TUNING.weight_integral * x[2] ** 2
        cost += periods * URGENCY**2 * tracking
        cost += periods * TUNING.weight_reduction * (REQUEST_NM - torque_nm) ** 2
        cost += TUNING.weight_change * (torque_nm - last) ** 2
        last = torque_nm
    assert problem.at(plan) == pytest.approx(cost / TUNING.weight_change)


def test_the_gradient_is_the_slope_of_the_cost(problem: Linearisation) -> None:
    plan = np.linspace(80.0, 120.0, len(TUNING.blocks))
    problem.at(plan)
    gradient = problem.gradient.copy()
    for index, slope in enumerate(gradient):
        step = np.zeros_like(plan)
        step[index] = 1e-3
        difference = (problem.at(plan + step) - problem.at(plan - step)) / 2e-3
        assert slope == pytest.approx(difference, rel=1e-4, abs=1e-4)


def test_a_plan_takes_no_more_iterations_than_allowed_and_stays_in_the_box() -> None:
    optimiser = DrivelineOptimiser(SETTINGS, VEHICLE)
    optimiser.state[:] = STATE
    plan = optimiser.plan(LAST_NM, REQUEST_NM)
    assert plan.status in (SolveStatus.OK, SolveStatus.MAX_ITERATIONS)
    assert plan.iterations <= TUNING.max_iterations
    assert plan.inputs.min() >= -1e-9
    assert plan.inputs.max() <= REQUEST_NM + 1e-9


def test_the_law_is_softer_at_walking_pace() -> None:
    def cut(speed_mps: float) -> float:
        optimiser = DrivelineOptimiser(SETTINGS, VEHICLE)
        optimiser.observe(wheel_at(speed_mps, 0.2, 120.0), 0.0)
        return 120.0 - float(optimiser.plan(120.0, 200.0).inputs[0])

    hard = SETTINGS.default.nmpc.soft_speed_mps
    assert 0.0 < cut(0.3 * hard) < cut(hard)


@pytest.mark.parametrize("speed_mps", [2.0, 6.0, 25.0])
def test_behind_delay_and_driveline_the_slip_settles_at_its_reference(speed_mps: float) -> None:
    loop = drive(driveline_mpc(SETTINGS, VEHICLE), 2.0, speed_mps)
    assert loop.slip.max() < 0.2
    assert np.abs(loop.slip[-250:] - 0.1).max() < 0.01
    assert chatter_nm(loop) < 0.1


class Counting:
    """A law, and the iterations of its steps."""

    def __init__(self) -> None:
        self._law = driveline_mpc(SETTINGS, VEHICLE)
        self.iterations: list[int] = []

    def step(self, wheel: WheelState, torque_ref_nm: float) -> Proposal:
        proposal = self._law.step(wheel, torque_ref_nm)
        self.iterations.append(proposal.iterations)
        return proposal

    def reset(self) -> None:
        raise NotImplementedError


def test_where_steps_shrink_well_a_tick_needs_one_linearisation() -> None:
    law = Counting()
    drive(law, 1.0)
    asked = np.trim_zeros(law.iterations)
    assert asked[0] == 2  # nothing is known yet
    assert np.mean(np.array(asked) == 1) > 0.8


@pytest.mark.parametrize("delay", [2, 4])
def test_a_delay_wrong_by_a_period_degrades_but_does_not_destabilise(delay: int) -> None:
    loop = drive(driveline_mpc(SETTINGS, VEHICLE), 2.0, delay=delay, believed_delay=3)
    assert loop.slip.max() < 0.25
    assert np.abs(loop.slip[-250:] - 0.1).max() < 0.01


def test_without_a_motor_on_the_bus_the_state_is_a_steady_one() -> None:
    optimiser = DrivelineOptimiser(SETTINGS, VEHICLE)
    blind = replace(wheel_at(5.0, 0.1), motor_torque_nm=math.nan)
    optimiser.observe(blind, 0.0)
    state = optimiser.state
    assert np.isfinite(state).all()
    assert VEHICLE.gear_ratio * state[3] == pytest.approx(state[6] * VEHICLE.wheel_radius_m)
    assert state[5] * LINE.shaft_stiffness_nmprad == pytest.approx(state[6] * 0.318)


def test_a_force_beyond_the_model_is_learnt_and_bounded() -> None:
    disturbance = ForceDisturbance(SETTINGS, VEHICLE, 0.02)
    wheel = wheel_at(5.0, 0.1)
    static_n = float(tyre_force_n(wheel.slip_ratio, VEHICLE))
    for _ in range(200):
        force_n = disturbance.update(replace(wheel, tyre_force_n=static_n - 300.0))
    assert disturbance.value_n == pytest.approx(-300.0, abs=1.0)
    assert force_n == pytest.approx(static_n - 300.0, abs=1.0)
    for _ in range(200):
        disturbance.update(replace(wheel, tyre_force_n=-1e6))
    assert disturbance.value_n == -VEHICLE.wheel_load_n


def test_without_an_observed_force_nothing_is_learnt() -> None:
    disturbance = ForceDisturbance(SETTINGS, VEHICLE, 0.02)
    for _ in range(200):
        force_n = disturbance.update(wheel_at(5.0, 0.1))
    assert disturbance.value_n == 0.0
    assert force_n == pytest.approx(float(tyre_force_n(wheel_at(5.0, 0.1).slip_ratio, VEHICLE)))
