"""The integral of the slip error and its anti-windup."""

from __future__ import annotations

import pytest

from tcs_hil.control.integrator import BoundedIntegral, SlipErrorIntegral


@pytest.fixture
def integral() -> SlipErrorIntegral:
    return SlipErrorIntegral(slip_reference=0.1, period_s=0.002)


def test_it_integrates_the_error_while_torque_is_reduced(integral: SlipErrorIntegral) -> None:
    integral.advance(slip_ratio=0.15, torque_nm=90.0, torque_ref_nm=100.0)
    integral.advance(slip_ratio=0.05, torque_nm=0.0, torque_ref_nm=100.0)
    integral.advance(slip_ratio=0.20, torque_nm=98.9, torque_ref_nm=100.0)
    assert integral.value_s == pytest.approx(0.002 * (-0.05 + 0.05 - 0.1))


@pytest.mark.parametrize(("torque_nm", "torque_ref_nm"), [(100.0, 100.0), (99.0, 100.0), (0, 0)])
def test_it_stands_still_while_the_driver_decides(
    integral: SlipErrorIntegral, torque_nm: float, torque_ref_nm: float
) -> None:
    integral.advance(0.02, torque_nm, torque_ref_nm)
    assert integral.value_s == 0.0


def test_a_ramp_of_one_newton_metre_per_tick_does_not_wind_it_up(
    integral: SlipErrorIntegral,
) -> None:
    # The paper's ramp: comparing with the next request would be decided by rounding.
    for tick in range(250):
        request = 250.0 * (tick * 0.002) / 0.5
        integral.advance(0.0, request, request)
    assert integral.value_s == 0.0


def test_reset_takes_it_back_to_zero(integral: SlipErrorIntegral) -> None:
    integral.advance(0.2, 50.0, 100.0)
    integral.reset()
    assert integral.value_s == 0.0


@pytest.fixture
def bounded() -> BoundedIntegral:
    return BoundedIntegral(slip_reference=0.1, period_s=0.002, limit_s=0.001)


def test_the_bounded_integral_stays_within_its_limit(bounded: BoundedIntegral) -> None:
    for _ in range(1000):
        bounded.advance(0.4, 50.0, 100.0)
    assert bounded.value_s == -0.001


@pytest.mark.parametrize(("slip_ratio", "torque_nm"), [(0.05, 100.0), (0.3, 0.0)])
def test_at_a_bound_an_error_that_pushes_outwards_does_not_count(
    bounded: BoundedIntegral, slip_ratio: float, torque_nm: float
) -> None:
    bounded.advance(slip_ratio, torque_nm, 100.0)
    assert bounded.value_s == 0.0


@pytest.mark.parametrize(("slip_ratio", "torque_nm"), [(0.3, 100.0), (0.05, 0.0)])
def test_at_a_bound_an_error_that_leads_back_inside_counts(
    bounded: BoundedIntegral, slip_ratio: float, torque_nm: float
) -> None:
    bounded.advance(slip_ratio, torque_nm, 100.0)
    assert bounded.value_s == pytest.approx(0.002 * (0.1 - slip_ratio))
