"""Radial dictionaries: kernels, sizes, centres drawn from the data and kept in the file."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tcs_hil.errors import ModelError
from tcs_hil.model.dataset import DatasetSettings
from tcs_hil.model.edmd import IdentificationSettings, identify
from tcs_hil.model.lifting import make_dictionary
from tcs_hil.model.predictor import KoopmanPredictor
from tcs_hil.model.radial import centre_count, draw_centres, gaussian, thin_plate

SMALL = DatasetSettings(trajectories=40, samples=50)


def test_the_thin_plate_is_r_squared_log_r_and_zero_at_its_centre() -> None:
    assert thin_plate(4.0) == pytest.approx(4.0 * math.log(2.0))
    assert thin_plate(0.0) == 0.0


def test_the_gaussian_falls_to_one_over_root_e_at_one_standard_deviation() -> None:
    assert gaussian(0.0) == 1.0
    assert gaussian(1.0) == pytest.approx(math.exp(-0.5))


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize("name", ["thin-plate", "gaussian"])
def test_a_radial_dictionary_is_as_large_as_the_monomials_of_its_order(name, order) -> None:
    centres = tuple((float(k), -float(k)) for k in range(centre_count(order)))
    dictionary = make_dictionary(name, order, centres)
    assert dictionary.size == make_dictionary("monomials", order).size
    assert len(dictionary.observables(0.3, -0.2, 0.1)) == dictionary.size


def test_centres_that_do_not_fit_the_order_are_refused() -> None:
    with pytest.raises(ModelError, match="2 centres do not fit dictionary 'gaussian' of order 4"):
        make_dictionary("gaussian", 4, ((0.0, 0.0), (1.0, 1.0)))


def test_centres_are_states_of_the_data_and_none_is_drawn_twice() -> None:
    states = np.arange(40.0).reshape(20, 2)
    centres = draw_centres(states, 12, seed=3)
    assert len(set(centres)) == 12
    assert set(centres) <= {tuple(row) for row in states.tolist()}
    with pytest.raises(ModelError, match="21 centres cannot be drawn from 20 states"):
        draw_centres(states, 21, seed=3)


@pytest.mark.parametrize("name", ["thin-plate", "gaussian"])
def test_a_predictor_keeps_its_centres_in_its_file(name, tmp_path) -> None:
    predictor = identify(IdentificationSettings(dataset=SMALL, dictionary=name, order=3))
    predictor.save(tmp_path / "radial.npz")
    copy = KoopmanPredictor.load(tmp_path / "radial.npz", 0.002)
    assert copy.provenance.centres == predictor.provenance.centres
    np.testing.assert_array_equal(copy.lift(0.4, 20.0), predictor.lift(0.4, 20.0))
