"""The Koopman MPC against its problem written as plain bounded least squares."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from tcs_hil.control.integrator import SlipErrorIntegral
from tcs_hil.control.kmpc import KoopmanOptimiser
from tcs_hil.control.predictive import PredictiveController
from tcs_hil.control.protocol import SolveStatus, WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.predictor import KoopmanPredictor
from tests.control.quarter_car import constant_friction, drive, varying_friction
from tests.control.recorder import Recorder, wheel_at

HORIZON, REFERENCE, AGREEMENT_NM = 5, 0.1, 2e-3
W_P, W_I, W_U = 0.75, 500.0, 1e-6


def reference_plan(
    predictor: KoopmanPredictor, wheel: WheelState, integral_s: float, torque_ref_nm: float
) -> np.ndarray:
    """Optimal torques (N,) in Nm by rolling the predictor out; no condensing, no Hessian."""
    request = predictor.scale_input(torque_ref_nm)

    def residuals(scaled: np.ndarray) -> np.ndarray:
        z, e_int, terms = predictor.lift(wheel.slip_speed_mps, wheel.wheel_speed_radps), 0.0, []
        e_int = integral_s
        for u in scaled:
            e_int += predictor.period_s * (REFERENCE - z[predictor.slip_index])
            z = predictor.a @ z + predictor.b[:, 0] * u
            error = REFERENCE - z[predictor.slip_index]
            terms += [W_P**0.5 * error, W_I**0.5 * e_int, W_U**0.5 * (request - u)]
        return np.array(terms)

    constant = residuals(np.zeros(HORIZON))
    slopes = np.column_stack([residuals(unit) - constant for unit in np.eye(HORIZON)])
    box = (predictor.scale_input(0.0), request)
    scaled = lsq_linear(slopes, -constant, box, method="bvls", tol=1e-15).x
    return scaled * predictor.scaling.torque_std_nm + predictor.scaling.torque_mean_nm


@pytest.mark.parametrize(
    ("friction", "duration_s"), [(constant_friction, 3.0), (varying_friction, 8.0)]
)
def test_along_a_manoeuvre_the_plan_is_the_exact_minimiser(
    predictor: KoopmanPredictor, friction: Callable[[float], float], duration_s: float
) -> None:
    settings = ControlSettings()
    recorder = Recorder(KoopmanOptimiser(predictor, settings.kmpc, settings.slip_reference))
    integral = SlipErrorIntegral(settings.slip_reference, settings.period_s)
    drive(PredictiveController(recorder, integral), friction, duration_s, 50.0)
    assert all(call.plan.status is SolveStatus.OK for call in recorder.calls)
    for call in recorder.calls[::7]:
        expected = reference_plan(predictor, call.wheel, call.integral_s, call.torque_ref_nm)
        assert np.abs(call.plan.inputs - expected).max() < AGREEMENT_NM


def test_from_any_state_the_plan_is_the_exact_minimiser(predictor: KoopmanPredictor) -> None:
    settings = ControlSettings()
    optimiser = KoopmanOptimiser(predictor, settings.kmpc, settings.slip_reference)
    rng = np.random.default_rng(11)
    for _ in range(300):
        wheel = wheel_at(rng.uniform(0.0, 30.0), rng.uniform(-0.1, 0.9))
        integral_s, torque_ref_nm = rng.uniform(-0.02, 0.02), rng.uniform(0.0, 250.0)
        plan = optimiser.plan(wheel, integral_s, torque_ref_nm)
        assert plan.status is SolveStatus.OK
        expected = reference_plan(predictor, wheel, integral_s, torque_ref_nm)
        assert np.abs(plan.inputs - expected).max() < AGREEMENT_NM
