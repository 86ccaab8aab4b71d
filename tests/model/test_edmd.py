"""The regression against a known system, against pykoop, and against the shipped model."""

from __future__ import annotations

import numpy as np
import pykoop
import pytest

from tcs_hil.errors import ModelError
from tcs_hil.model.dataset import DatasetSettings, generate
from tcs_hil.model.edmd import IdentificationSettings, fit, identify
from tcs_hil.model.vehicle import Vehicle


def test_a_linear_system_is_recovered_exactly():
    rng = np.random.default_rng(3)
    a, b = rng.normal(size=(3, 3)), rng.normal(size=(3, 1))
    z, u = rng.normal(size=(50, 3)), rng.normal(size=(50, 1))
    found = fit(z, u, z @ a.T + u @ b.T)
    np.testing.assert_allclose(found.a, a, atol=1e-13)
    np.testing.assert_allclose(found.b, b, atol=1e-13)
    assert max(found.quality.residual_rms) < 1e-14


def test_the_residual_is_the_noise_of_the_data():
    rng = np.random.default_rng(4)
    z, u = rng.normal(size=(20_000, 2)), rng.normal(size=(20_000, 1))
    noise = rng.normal(size=(20_000, 2)) * [0.1, 0.5]
    found = fit(z, u, z + noise)
    assert found.quality.residual_rms == pytest.approx((0.1, 0.5), rel=0.03)


def test_the_condition_number_is_one_for_orthogonal_columns_of_any_length():
    z, u = np.diag([1.0, 1e-3, 1e6])[:, :2], np.array([[0.0], [0.0], [1e6]])
    assert fit(z, u, z).quality.condition_number == pytest.approx(1.0)


def test_the_regression_agrees_with_pykoop_on_the_same_lifted_data(identified):
    data = generate(Vehicle(), DatasetSettings(), identified.provenance.seed)
    z, z_next = identified.lift(*data.x.T), identified.lift(*data.x_next.T)
    peer = pykoop.Edmd(alpha=0)
    unshifted = np.hstack((z, identified.scale_input(data.u)))
    peer.fit(unshifted, z_next, n_inputs=1, episode_feature=False)
    nz = identified.nz
    # Same minimum, other arithmetic: the peer's Gram matrix has a condition of 1e9.
    np.testing.assert_allclose(identified.a, peer.coef_.T[:, :nz], rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(identified.b, peer.coef_.T[:, nz:], rtol=1e-8, atol=1e-8)


def test_data_that_leave_the_answer_open_are_refused():
    z = np.ones((10, 2))
    with pytest.raises(ModelError, match="excites 2 of 3 directions"):
        fit(z, np.arange(10.0)[:, np.newaxis], z)


def test_an_observable_that_is_always_zero_is_refused_without_a_warning():
    z = np.column_stack((np.arange(10.0), np.zeros(10)))
    with pytest.raises(ModelError, match="excites 2 of 3"):
        fit(z, np.arange(10.0)[:, np.newaxis] ** 2, z)


def test_the_shipped_model_is_what_identification_makes(paper, identified):
    # Another BLAS may round differently; 1e-9 leaves room for that and nothing else.
    np.testing.assert_allclose(paper.a, identified.a, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(paper.b, identified.b, rtol=1e-9, atol=1e-9)
    assert paper.scaling.omega_std_radps == pytest.approx(identified.scaling.omega_std_radps)
    assert paper.provenance.seed == identified.provenance.seed


def test_validity_is_the_range_of_the_data(identified):
    validity = identified.validity
    assert 0.0 < validity.speed_mps[0] < 0.1
    assert 40 / 3.6 < validity.speed_mps[1] < 50 / 3.6
    assert validity.torque_nm == pytest.approx((50.0, 175.0), abs=0.01)
    assert 0.2 < validity.slip_ratio[1] < 1.0


def test_the_constant_stays_constant_and_the_order_sets_the_size():
    small = DatasetSettings(trajectories=50)
    predictor = identify(IdentificationSettings(dataset=small, order=2))
    assert predictor.nz == 7
    np.testing.assert_allclose(predictor.a[-1], np.eye(7)[-1], atol=1e-12)
    assert abs(predictor.b[-1, 0]) < 1e-12
