"""The dense form against the recursion it replaces."""

from __future__ import annotations

import numpy as np

from tcs_hil.control.condense import condense, extend
from tcs_hil.model.predictor import KoopmanPredictor


def test_outputs_follow_the_predictor_and_the_euler_integral(predictor: KoopmanPredictor) -> None:
    torques, e_int, reference = np.array([60.0, 90.0, 150.0, 0.0, 120.0]), 3e-3, 0.1
    x0 = np.array([0.4, 20.0])
    dense = condense(extend(predictor), len(torques))
    xi0 = np.append(predictor.lift(*x0), (e_int, reference))
    outputs = dense.gamma @ xi0 + dense.theta @ predictor.scale_input(torques)

    kappa = predictor.predict(x0, torques)[:, 2]
    integral = e_int + predictor.period_s * np.cumsum(reference - kappa[:-1])
    expected = np.column_stack((kappa[1:], integral, np.full(5, reference)))
    np.testing.assert_allclose(outputs.reshape(5, 3), expected, atol=1e-12)


def test_an_input_never_acts_on_the_past(predictor: KoopmanPredictor) -> None:
    theta = condense(extend(predictor), 4).theta.reshape(4, 3, 4)
    future = [theta[k, :, j] for k in range(4) for j in range(k + 1, 4)]
    assert not np.any(future)
    assert np.any(theta[0, :, 0])
