"""The data set has the paper's size and statistics."""

from __future__ import annotations

import numpy as np
import pytest

from tcs_hil.model.dataset import Dataset, DatasetSettings, generate
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.model.wheel import rk4_step

VEHICLE = Vehicle()


@pytest.fixture(scope="module")
def data() -> Dataset:
    return generate(VEHICLE, DatasetSettings(), seed=1)


def test_the_defaults_give_the_papers_size(data):
    assert data.x.shape == data.x_next.shape == (250_000, 2)
    assert data.u.shape == (250_000, 1)


def test_every_triple_is_one_step_of_the_dynamics(data):
    some = slice(0, None, 997)
    stepped = rk4_step(data.x[some], data.u[some, 0], VEHICLE, 0.002)
    np.testing.assert_allclose(data.x_next[some], stepped, rtol=1e-12, atol=1e-14)


def test_each_run_starts_where_the_previous_one_did_not_end(data):
    np.testing.assert_array_equal(data.x[1:250], data.x_next[:249])
    assert not np.allclose(data.x[250], data.x_next[249])


def test_initial_speed_and_slip_are_uniform_over_the_papers_ranges(data):
    s, omega = data.x[::250].T
    rim = omega * VEHICLE.wheel_radius_m
    for values, high in ((rim - s, 40 / 3.6), (s / rim, 0.2)):
        assert values.min() >= 0.0
        assert values.max() <= high
        # Four standard errors of the mean and of the spread of 1000 uniform draws.
        assert values.mean() == pytest.approx(high / 2, abs=4 * high / np.sqrt(12 * 1000))
        assert values.std() == pytest.approx(high / np.sqrt(12), rel=0.06)


def test_torque_is_uniform_and_redrawn_at_every_sample(data):
    torque = data.u.reshape(1000, 250)
    assert torque.min() >= 50.0
    assert torque.max() <= 175.0
    assert torque.mean() == pytest.approx(112.5, abs=0.3)  # four standard errors
    following = np.corrcoef(torque[:, :-1].ravel(), torque[:, 1:].ravel())[0, 1]
    assert abs(following) < 4 / np.sqrt(249_000)


def test_no_run_goes_backwards_or_blows_up_even_from_standstill(data):
    s, omega = data.x_next.T
    assert np.isfinite(data.x_next).all()
    assert omega.min() > 0.0
    assert (omega * VEHICLE.wheel_radius_m - s).min() > 0.0


def test_the_same_seed_gives_the_same_data_and_another_seed_other_data():
    small = DatasetSettings(trajectories=3, samples=5)
    first, again, other = (generate(VEHICLE, small, seed) for seed in (7, 7, 8))
    np.testing.assert_array_equal(first.x_next, again.x_next)
    assert not np.array_equal(first.x_next, other.x_next)


def test_progress_rises_to_one():
    seen: list[float] = []
    generate(VEHICLE, DatasetSettings(trajectories=2, samples=4), 1, seen.append)
    assert seen == [0.25, 0.5, 0.75, 1.0]


@pytest.mark.parametrize(
    "bad",
    [
        {"torque_nm": (175.0, 50.0)},
        {"initial_speed_mps": (-1.0, 5.0)},
        {"initial_slip_ratio": (0.0, 1.0)},
    ],
)
def test_impossible_ranges_are_refused(bad):
    with pytest.raises(ValueError, match="must"):
        DatasetSettings(**bad)
