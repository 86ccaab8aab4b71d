"""The default Koopman MPC: its program against plain least squares, and its loop."""

from __future__ import annotations

import math

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.optimize import lsq_linear

from tcs_hil.control.bank_kmpc import FORCE_FAST_MPS, FORCE_SLOW_MPS, BankOptimiser
from tcs_hil.control.bank_law import bank_mpc
from tcs_hil.control.bank_osqp import BandProblem
from tcs_hil.control.bank_problem import CALM_MPS, INTEGRAL, bands_of, output_weights
from tcs_hil.control.protocol import Controller, SolveStatus
from tcs_hil.control.settings import ControlSettings
from tcs_hil.errors import ConfigError
from tcs_hil.model.bank import KoopmanBank, default_bank_path
from tcs_hil.model.fleet import FleetSettings
from tcs_hil.model.observables import Observable
from tcs_hil.model.tyre import tyre_force_n
from tcs_hil.model.vehicle import Vehicle
from tests.control.believed_car import chatter_nm, drive, nominal
from tests.control.recorder import wheel_at

SETTINGS = ControlSettings()
BANK = KoopmanBank.load(default_bank_path(), SETTINGS.period_s)
AGREEMENT_NM = 0.03  # the bus tells 0.05 Nm apart


@pytest.fixture
def law() -> Controller:
    return bank_mpc(SETTINGS, BANK)


def reference_plan(band: int, x: np.ndarray, last_nm: float, torque_ref_nm: float) -> np.ndarray:
    """Optimal torques (N,) in Nm by rolling the band out; no condensing, no Hessian."""
    tuning = SETTINGS.default.kmpc
    system = bands_of(BANK, SETTINGS)[band].system
    centre_mps = BANK.centre_mps[band]
    share = centre_mps / tuning.weights_speed_mps * min(centre_mps / CALM_MPS, 1.0) ** 0.5

    def residuals(torques: np.ndarray) -> np.ndarray:
        state, previous, terms = x, last_nm, []
        for u in torques:
            state = system.a @ state + system.b[:, 0] * u
            error = state[Observable.SLIP_RATIO] - SETTINGS.slip_reference * state[Observable.ONE]
            terms += [share * tuning.weight_slip**0.5 * error]
            terms += [share * tuning.weight_integral**0.5 * state[INTEGRAL]]
            terms += [tuning.weight_reduction**0.5 * (torque_ref_nm - u)]
            terms += [tuning.weight_change**0.5 * (u - previous)]
            previous = u
        return np.array(terms)

    constant = residuals(np.zeros(tuning.horizon))
    slopes = np.column_stack([residuals(unit) - constant for unit in np.eye(tuning.horizon)])
    return lsq_linear(slopes, -constant, (0.0, torque_ref_nm), method="bvls", tol=1e-15).x


@pytest.mark.parametrize("band", [0, 4, 9])
def test_the_plan_of_a_band_is_the_exact_minimiser(band: int) -> None:
    problem = BandProblem(bands_of(BANK, SETTINGS)[band].cost)
    optimiser = BankOptimiser(SETTINGS, BANK)
    rng = np.random.default_rng(11)
    for _ in range(20):
        speed_mps, kappa = BANK.centre_mps[band], rng.uniform(0.0, 0.3)
        optimiser.observe(wheel_at(speed_mps, kappa, 120.0), rng.uniform(-0.01, 0.01))
        x = optimiser.state.copy()
        plan = problem.solve(x, 120.0, 200.0)
        assert plan.status is SolveStatus.OK
        expected = reference_plan(band, x, 120.0, 200.0)
        assert np.abs(plan.inputs - expected).max() < AGREEMENT_NM


def test_the_state_is_carried_through_every_torque_under_way() -> None:
    optimiser, system = BankOptimiser(SETTINGS, BANK), bands_of(BANK, SETTINGS)[4].system
    optimiser.observe(wheel_at(BANK.centre_mps[4], 0.1, 120.0), 0.001)
    x = optimiser.state.copy()
    optimiser.roll_forward([40.0, 60.0], 0.25)
    x += 0.25 * (system.a @ x + system.b[:, 0] * 40.0 - x)
    x = system.a @ x + system.b[:, 0] * 60.0
    np.testing.assert_allclose(optimiser.state, x, rtol=1e-12)


def test_without_a_motor_on_the_bus_the_pi_goes_on_from_what_was_sent(law: Controller) -> None:
    wheel = wheel_at(6.0, 0.1, 100.0)
    known = [law.step(wheel, 200.0).torque_nm for _ in range(20)][-1]
    proposal = law.step(replace(wheel, motor_torque_nm=math.nan), 200.0)
    assert proposal.status is SolveStatus.OK
    assert proposal.torque_nm == pytest.approx(known, abs=1.0)  # no jump, no wide-open throttle


def test_a_tyre_that_pushes_less_is_foreseen_to_go_on_so_above_walking_pace_alone() -> None:
    def foreseen_radps(speed_mps: float, lacking_n: float) -> float:
        optimiser, wheel = BankOptimiser(SETTINGS, BANK), wheel_at(speed_mps, 0.05, 50.0)
        believed_n = float(tyre_force_n(wheel.slip_ratio, Vehicle()))
        for _ in range(200):
            optimiser.observe(replace(wheel, tyre_force_n=believed_n - lacking_n), 0.0)
        optimiser.roll_forward([50.0] * 10, 1.0)
        return float(optimiser.state[Observable.WHEEL_SPEED])

    slow, fast = FORCE_SLOW_MPS, FORCE_FAST_MPS
    assert foreseen_radps(slow, 500.0) == foreseen_radps(slow, 0.0)
    assert foreseen_radps(fast, 500.0) > foreseen_radps(fast, 0.0) + 0.1


@pytest.mark.parametrize("border", [1.0978, 3.4435, 7.0])
def test_the_command_is_continuous_in_speed(border: float) -> None:
    def first(speed_mps: float) -> float:
        law = bank_mpc(SETTINGS, BANK)
        return [law.step(wheel_at(speed_mps, 0.08, 100.0), 150.0).torque_nm for _ in range(5)][-1]

    assert abs(first(border * 1.0001) - first(border * 0.9999)) < 0.05


def test_an_error_of_slip_speed_weighs_the_same_at_any_speed_but_less_near_standstill() -> None:
    tuning = SETTINGS.default.kmpc
    slip_mps, speeds_mps = 0.1, (CALM_MPS, 5.0, 50.0, 0.5 * CALM_MPS)
    *costs, slow = [output_weights(tuning, v)[0] * (slip_mps / v) ** 2 for v in speeds_mps]
    assert costs == pytest.approx([costs[1]] * 3)
    assert slow == pytest.approx(0.5 * costs[0])


@pytest.mark.parametrize(("speed_mps", "peak"), [(1.0, 0.13), (6.0, 0.13), (25.0, 0.18)])
def test_behind_delay_and_driveline_the_slip_settles_at_its_reference(
    law: Controller, speed_mps: float, peak: float
) -> None:
    loop = drive(law, 2.0, speed_mps)
    assert loop.slip.max() < peak
    assert np.abs(loop.slip[-250:] - 0.1).max() < 0.005
    assert chatter_nm(loop, after_s=1.0) < 0.1


@pytest.mark.parametrize("delay", [2, 4])
def test_a_delay_wrong_by_a_period_degrades_but_does_not_destabilise(
    law: Controller, delay: int
) -> None:
    loop = drive(law, 2.0, delay=delay, believed_delay=3)
    assert loop.slip.max() < 0.15
    assert np.abs(loop.slip[-250:] - 0.1).max() < 0.005


@pytest.mark.parametrize(
    "car",
    [
        nominal(shaft_stiffness_nmprad=(8999.0, 9001.0), shaft_damping_nmsprad=(8.0, 8.1)),
        nominal(shaft_stiffness_nmprad=(3000.0, 3001.0), shaft_damping_nmsprad=(8.0, 8.1)),
        nominal(motor_lag_s=(0.0199, 0.02)),
        nominal(mass_share=(0.8, 0.801)),
    ],
    ids=["stiff shaft", "soft shaft", "slow motor", "light car"],
)
def test_another_car_is_held_too(law: Controller, car: FleetSettings) -> None:
    loop = drive(law, 2.0, fleet=car)
    assert loop.slip.max() < 0.16
    assert np.abs(loop.slip[-250:] - 0.1).max() < 0.01


@pytest.mark.parametrize("grip", [0.5, 1.5])
def test_another_road_leaves_no_offset(law: Controller, grip: float) -> None:
    loop = drive(law, 2.5, grip=lambda time_s: 1.0 if time_s < 1.0 else grip)
    assert loop.slip.max() < 0.28
    assert np.abs(loop.slip[-100:] - 0.1).max() < 0.01


def test_after_a_reset_a_run_repeats_itself_bit_for_bit(law: Controller) -> None:
    first = drive(law, 0.6).proposed_nm
    law.reset()
    assert (drive(law, 0.6).proposed_nm == first).all()


def test_a_bank_for_another_period_is_refused() -> None:
    with pytest.raises(ConfigError, match=r"period_s is 0\.004, but the bank is for 0\.002"):
        bank_mpc(replace(SETTINGS, period_s=0.004), BANK)


@pytest.mark.parametrize("request_nm", [0.0, 40.0, 200.0])
def test_a_proposal_lies_between_zero_and_the_request(law: Controller, request_nm: float) -> None:
    rng = np.random.default_rng(5)
    for _ in range(100):
        wheel = wheel_at(rng.uniform(0.0, 60.0), rng.uniform(-0.2, 0.98), 100.0)
        assert 0.0 <= law.step(wheel, request_nm).torque_nm <= request_nm
