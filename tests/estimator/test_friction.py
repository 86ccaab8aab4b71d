"""Friction from force and slip, and what it is worth."""

from __future__ import annotations

import pytest

from tcs_hil.estimator.friction import FrictionEstimate
from tcs_hil.model.tyre import tyre_force_n
from tcs_hil.model.vehicle import Vehicle

VEHICLE = Vehicle()


def force_n(mu: float, kappa: float) -> float:
    return float(tyre_force_n(kappa, VEHICLE)) * mu / VEHICLE.friction_ratio


def learnt(mu: float, kappa: float, ticks: int = 500) -> FrictionEstimate:
    estimate = FrictionEstimate(VEHICLE, 0.002)
    for _ in range(ticks):
        estimate.update(force_n(mu, kappa), kappa)
    return estimate


@pytest.mark.parametrize("mu", [0.08, 0.3, 0.8])
def test_at_the_reference_slip_the_friction_is_found_and_trusted(mu: float) -> None:
    estimate = learnt(mu, 0.1)
    assert estimate.value_ratio == pytest.approx(mu, rel=0.01)
    assert estimate.confidence_ratio > 0.9


def test_a_rolling_wheel_tells_nothing() -> None:
    estimate = learnt(0.08, 0.02)
    assert (estimate.value_ratio, estimate.confidence_ratio) == (VEHICLE.friction_ratio, 0.0)


def test_confidence_fades_without_news() -> None:
    estimate = learnt(0.15, 0.1)
    for _ in range(1000):
        estimate.update(0.0, 0.0)
    assert estimate.value_ratio == pytest.approx(0.15, rel=0.01)
    assert estimate.confidence_ratio < 0.5


def test_a_force_that_is_no_number_or_no_road_changes_nothing_beyond_bounds() -> None:
    estimate = learnt(0.3, 0.1)
    estimate.update(float("nan"), 0.1)
    assert estimate.value_ratio == pytest.approx(0.3, rel=0.01)
    for _ in range(5000):
        estimate.update(1e9, 0.1)
    assert estimate.value_ratio <= 1.5
