"""Observables: order, scaling, and one path for floats and columns."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tcs_hil.errors import ModelError
from tcs_hil.model.lifting import Lifting, Monomials, make_dictionary
from tcs_hil.model.scaling import Scaling, fit_scaling
from tcs_hil.model.vehicle import Vehicle

SCALING = Scaling(
    s_mean_mps=0.4,
    s_std_mps=0.25,
    omega_mean_radps=20.0,
    omega_std_radps=11.0,
    torque_mean_nm=112.0,
    torque_std_nm=36.0,
)
SPEED = st.floats(-50.0, 300.0)


def test_the_lifted_state_is_s_omega_slip_then_rising_monomials_then_one():
    s, w = 2.0, 3.0
    expected = [s, w, 0.1, s * s, s * w, w * w, s**3, s * s * w, s * w * w, w**3, 1.0]
    assert Monomials(3).observables(s, w, 0.1) == expected


@pytest.mark.parametrize(("order", "size"), [(1, 4), (2, 7), (4, 16), (8, 46)])
def test_the_size_counts_every_monomial_once(order, size):
    dictionary = make_dictionary("monomials", order)
    assert dictionary.size == size == len(dictionary.observables(1.0, 1.0, 0.0))


@given(st.integers(1, 8), st.lists(st.tuples(SPEED, SPEED), min_size=1, max_size=5))
def test_lifting_one_state_equals_lifting_many(order, states):
    lifting = Lifting(Monomials(order), SCALING, Vehicle())
    many = lifting.lift(*np.array(states).T)
    one_by_one = [lifting.lift(s, omega) for s, omega in states]
    np.testing.assert_array_equal(many, one_by_one)


@given(SPEED, SPEED)
def test_unscaling_undoes_scaling(s, omega):
    assert SCALING.unscale_s(SCALING.scale_s(s)) == pytest.approx(s, abs=1e-12)
    assert SCALING.unscale_omega(SCALING.scale_omega(omega)) == pytest.approx(omega, abs=1e-12)


def test_one_scaling_takes_states_and_successors_together():
    x, x_next = np.array([[0.0, 1.0], [0.0, 3.0]]), np.array([[4.0, 5.0], [4.0, 7.0]])
    scaling = fit_scaling(x, np.array([[1.0], [3.0]]), x_next)
    assert (scaling.s_mean_mps, scaling.s_std_mps) == (2.0, 2.0)
    assert (scaling.omega_mean_radps, scaling.omega_std_radps) == (4.0, pytest.approx(5**0.5))
    assert scaling.scale_torque(3.0) == 1.0


def test_a_quantity_that_never_changes_cannot_be_scaled():
    x = np.array([[0.0, 1.0], [1.0, 3.0]])
    with pytest.raises(ModelError, match="never changes"):
        fit_scaling(x, np.array([[100.0], [100.0]]), x)


def test_an_unknown_dictionary_is_named_with_the_known_ones():
    with pytest.raises(ModelError, match="'splines' is unknown; known are monomials"):
        make_dictionary("splines", 2)


@pytest.mark.parametrize("order", [0, 9])
def test_an_order_outside_its_bounds_is_refused(order):
    with pytest.raises(ModelError, match=f"not {order}"):
        make_dictionary("monomials", order)
