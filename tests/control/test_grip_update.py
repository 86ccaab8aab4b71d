"""The online update: it learns less grip, never more, and leaves an unmodelled lag alone."""

from __future__ import annotations

import math

import pytest
from msgspec.structs import replace

from tcs_hil.control.bank_law import bank_mpc
from tcs_hil.control.grip_update import GripEstimate
from tcs_hil.control.settings import BankKmpcSettings, ControlSettings, DefaultSettings
from tcs_hil.model.bank import KoopmanBank, default_bank_path
from tcs_hil.model.tyre import tyre_force_n
from tcs_hil.model.vehicle import Vehicle
from tests.control.believed_car import Loop, chatter_nm, drive, nominal
from tests.control.recorder import wheel_at

BANK = KoopmanBank.load(default_bank_path(), 0.002)


@pytest.fixture
def estimate() -> GripEstimate:
    return GripEstimate(Vehicle(), 0.002, least=1 / 3)


def feel(estimate: GripEstimate, grip: float, kappa: float = 0.08, ticks: int = 500) -> float:
    """A wheel at 6 m/s whose tyre has a share of the believed force."""
    wheel = wheel_at(6.0, kappa)
    force_n = grip * float(tyre_force_n(wheel.slip_ratio, Vehicle()))
    for _ in range(ticks):
        estimate.update(replace(wheel, tyre_force_n=force_n))
    return estimate.value


def held(update: bool, speed_mps: float, grip: float, lag_s: float = 0.005) -> Loop:
    tuning = BankKmpcSettings(online_update=update)
    law = bank_mpc(ControlSettings(default=DefaultSettings(kmpc=tuning)), BANK)
    car = nominal(motor_lag_s=(lag_s - 1e-5, lag_s + 1e-5))
    return drive(law, 1.5, speed_mps, fleet=car, grip=lambda _: grip)


def test_the_grip_is_learnt(estimate: GripEstimate) -> None:
    assert feel(estimate, 0.5) == pytest.approx(0.5, abs=0.01)
    assert feel(estimate, 0.8) == pytest.approx(0.8, abs=0.01)


def test_it_is_bounded_below_by_the_slippery_bank_and_above_by_the_believed_road(
    estimate: GripEstimate,
) -> None:
    assert feel(estimate, 0.1) == pytest.approx(1 / 3)
    assert feel(estimate, 2.0) == 1.0


def test_without_excitation_nothing_is_learnt_or_forgotten(estimate: GripEstimate) -> None:
    feel(estimate, 0.5)
    feel(estimate, 1.0, kappa=0.005)
    # Until the expected force has relaxed, ten ticks of the new one still count.
    assert estimate.value == pytest.approx(0.5, abs=0.1)


def test_without_an_observed_force_nothing_is_learnt(estimate: GripEstimate) -> None:
    for _ in range(100):
        estimate.update(replace(wheel_at(6.0, 0.1), tyre_force_n=math.nan))
    assert estimate.value == 1.0


def test_forces_that_no_grip_explains_fall_back_to_the_believed_road(
    estimate: GripEstimate,
) -> None:
    feel(estimate, 0.5)
    wheel = wheel_at(6.0, 0.1)
    for tick in range(200):
        estimate.update(replace(wheel, tyre_force_n=3000.0 * (-1) ** tick))
    assert estimate.value == 1.0


def test_a_reset_restores_the_believed_road(estimate: GripEstimate) -> None:
    feel(estimate, 0.5)
    estimate.reset()
    assert estimate.value == 1.0


def test_it_is_off_by_default() -> None:
    assert not ControlSettings().default.kmpc.online_update


@pytest.mark.parametrize("speed_mps", [3.0, 8.0])
@pytest.mark.parametrize("grip", [0.33, 0.5])
def test_where_the_tyre_has_less_grip_the_excess_of_slip_is_halved(
    grip: float, speed_mps: float
) -> None:
    plain, updated = held(False, speed_mps, grip), held(True, speed_mps, grip)
    assert updated.slip.max() - 0.1 < 0.5 * (plain.slip.max() - 0.1)


@pytest.mark.parametrize("speed_mps", [3.0, 8.0])
def test_a_lag_nobody_modelled_does_not_mislead_it(speed_mps: float) -> None:
    plain, updated = held(False, speed_mps, 1.0, 0.02), held(True, speed_mps, 1.0, 0.02)
    assert updated.slip.max() <= plain.slip.max() + 0.002
    assert chatter_nm(updated) <= chatter_nm(plain) + 0.01


def test_after_a_reset_a_run_repeats_itself_bit_for_bit() -> None:
    tuning = BankKmpcSettings(online_update=True)
    law = bank_mpc(ControlSettings(default=DefaultSettings(kmpc=tuning)), BANK)
    first = drive(law, 0.5, grip=lambda _: 0.5).proposed_nm
    law.reset()
    assert (drive(law, 0.5, grip=lambda _: 0.5).proposed_nm == first).all()
