"""Using a predictor."""

from __future__ import annotations

import numpy as np
import pytest

from tcs_hil.errors import ModelError
from tcs_hil.model.predictor import KoopmanPredictor
from tcs_hil.model.tyre import slip_ratio
from tcs_hil.model.wheel import rk4_step


def test_selection_and_slip_index_point_at_s_omega_and_slip(paper):
    z = paper.lift(0.5, 20.0)
    s, omega, kappa = paper.c @ z
    assert paper.scaling.unscale_s(s) == pytest.approx(0.5)
    assert paper.scaling.unscale_omega(omega) == pytest.approx(20.0)
    assert kappa == z[paper.slip_index] == slip_ratio(0.5, 20.0, paper.provenance.vehicle)


def test_one_predicted_step_is_close_to_the_dynamics(paper):
    x0 = np.array([0.6, 19.0])
    _, (s, omega, kappa) = paper.predict(x0, np.array([120.0]))
    truth = rk4_step(x0, 120.0, paper.provenance.vehicle, paper.period_s)
    # Three times the residual of the fit: 0.0075 m/s, 0.023 rad/s and 0.008.
    assert s == pytest.approx(truth[0], abs=0.025)
    assert omega == pytest.approx(truth[1], abs=0.07)
    assert kappa == pytest.approx(slip_ratio(*truth, paper.provenance.vehicle), abs=0.025)


def test_a_prediction_is_the_linear_recursion(paper):
    torques = np.array([60.0, 170.0, 100.0])
    z = paper.lift(0.6, 19.0)
    for u in paper.scale_input(torques):
        z = paper.a @ z + paper.b[:, 0] * u
    last = paper.predict(np.array([0.6, 19.0]), torques)[-1]
    np.testing.assert_allclose(last[2], z[paper.slip_index], rtol=1e-12)


def test_many_predictions_equal_each_alone(paper):
    x0 = np.array([[0.6, 19.0], [0.1, 8.0]])
    torques = np.array([[60.0, 170.0], [100.0, 90.0]])
    alone = [paper.predict(x, u) for x, u in zip(x0, torques, strict=True)]
    np.testing.assert_allclose(paper.predict(x0, torques), alone, rtol=1e-12)


def test_more_torque_means_more_slip(paper):
    assert paper.b[paper.slip_index, 0] > 0.0


@pytest.mark.parametrize(("rows", "columns"), [(15, 16), (16, 15)])
def test_matrices_that_do_not_fit_the_dictionary_are_refused(paper, rows, columns):
    with pytest.raises(ModelError, match="do not fit 16 observables"):
        KoopmanPredictor.build(paper.a[:rows, :columns], paper.b, paper.provenance)


def test_matrices_that_are_not_finite_are_refused(paper):
    with pytest.raises(ModelError, match="not finite"):
        KoopmanPredictor.build(paper.a * np.nan, paper.b, paper.provenance)
