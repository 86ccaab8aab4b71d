"""The disturbance of the bank's prediction: learnt slowly, and never more than a road can do."""

from __future__ import annotations

import math

import pytest

from tcs_hil.control.settings import ControlSettings
from tcs_hil.control.speed_disturbance import SpeedDisturbance
from tcs_hil.model.vehicle import Vehicle


@pytest.fixture
def disturbance() -> SpeedDisturbance:
    return SpeedDisturbance(ControlSettings(), Vehicle())


def learn(disturbance: SpeedDisturbance, missing_radps: float, ticks: int) -> float:
    """A plant that turns ``missing_radps`` per period faster than the bare prediction."""
    for _ in range(ticks):
        disturbance.learn(missing_radps)
    return disturbance.value_radps


def test_from_what_is_no_number_nothing_is_learnt(disturbance: SpeedDisturbance) -> None:
    disturbance.learn(math.nan)
    assert disturbance.value_radps == 0.0


def test_a_constant_error_is_learnt_with_the_observers_time(disturbance: SpeedDisturbance) -> None:
    ticks = round(ControlSettings().default.kmpc.observer_time_s / 0.002)
    assert learn(disturbance, 0.1, ticks) == pytest.approx(0.0632, abs=0.001)
    assert learn(disturbance, 0.1, 20 * ticks) == pytest.approx(0.1)


def test_it_is_limited_to_what_a_tyre_can_do(disturbance: SpeedDisturbance) -> None:
    vehicle = Vehicle()
    most = 0.002 * vehicle.wheel_load_n * vehicle.wheel_radius_m / vehicle.wheel_inertia_kgm2
    assert learn(disturbance, 50.0, 2000) == pytest.approx(most)


def test_one_absurd_tick_moves_it_only_a_little(disturbance: SpeedDisturbance) -> None:
    disturbance.learn(1e4)
    assert 0.0 < disturbance.value_radps < 0.15


def test_a_reset_forgets_it(disturbance: SpeedDisturbance) -> None:
    learn(disturbance, 0.1, 100)
    disturbance.reset()
    assert disturbance.value_radps == 0.0
