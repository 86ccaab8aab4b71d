"""Regression of a band, errors by speed, and what recorded drives may change."""

from __future__ import annotations

import numpy as np
import pytest

from tcs_hil.errors import ModelError
from tcs_hil.model.bank import KoopmanBank, default_bank_path
from tcs_hil.model.bank_evaluation import errors_of, simulated_errors
from tcs_hil.model.bank_identification import KNOWN, fit_band
from tcs_hil.model.bank_provenance import BandSettings
from tcs_hil.model.excitation import ExcitationSettings, Runs, Transitions, excite
from tcs_hil.model.fleet import Fleet, FleetSettings
from tcs_hil.model.observables import NZ, Observable
from tcs_hil.model.recorded_identification import refine
from tcs_hil.model.vehicle import Vehicle

SHIPPED = KoopmanBank.load(default_bank_path(), 0.002)
CAR = FleetSettings(
    friction_ratio=(0.29, 0.291),
    mass_share=(1.14, 1.15),
    shaft_stiffness_nmprad=(3000.0, 3010.0),
    shaft_damping_nmsprad=(29.0, 30.0),
    motor_lag_s=(0.0099, 0.010),
)
"""A car at the edge of the fleet: there is something to learn from it."""


def drive(excitation_nm: float, runs: int = 30) -> Runs:
    rng = np.random.default_rng(5)
    car = Fleet.draw(Vehicle(), CAR, runs, rng)
    settings = ExcitationSettings(
        torque_nm=(-excitation_nm, excitation_nm), samples=600, aim_slip_ratio=(0.05, 0.051)
    )
    return excite(car, settings, np.full(runs, 6.0), 0.002, rng)


def test_a_linear_system_is_recovered() -> None:
    rng = np.random.default_rng(3)
    a, b = rng.normal(size=(NZ, NZ)), rng.normal(size=NZ)
    z, u = rng.normal(size=(400, NZ)), rng.normal(size=400)
    z[:, Observable.ONE] = 1.0
    for later, now in KNOWN.items():
        a[later], b[later] = np.eye(NZ)[now], 0.0
    band = fit_band(Transitions(z, u, z @ a.T + u[:, np.newaxis] * b, np.ones(400)))
    np.testing.assert_allclose(band.a, a, atol=1e-6)
    np.testing.assert_allclose(band.b, b, atol=1e-6)
    assert band.fit.slip_residual_rms < 1e-6


def test_what_the_data_leave_open_stays_as_in_the_prior() -> None:
    rng = np.random.default_rng(4)
    prior = rng.normal(size=(NZ + 1, NZ))
    z, u = np.zeros((50, NZ)), np.zeros(50)
    band = fit_band(Transitions(z, u, z, np.ones(50)), prior, ridge=0.1)
    slip = Observable.SLIP_RATIO
    np.testing.assert_array_equal(band.a[slip], prior[:NZ, slip])


def test_the_shipped_bank_predicts_far_better_than_holding_in_every_bin_of_speed() -> None:
    for error in simulated_errors(SHIPPED):
        assert error.predictions > 20
        # Standstill is the hardest: there the slip ratio follows the torque at once.
        assert error.many_steps < (0.75 if error.speed_mps[1] <= 1.0 else 0.5) * error.held


def test_a_bin_without_predictions_has_no_error() -> None:
    error = errors_of(SHIPPED, drive(60.0, runs=1), (50.0, 60.0))
    assert error.predictions == 0
    assert np.isnan(error.many_steps)


def test_an_excited_drive_makes_the_bank_fit_the_car_on_blocks_it_has_not_seen() -> None:
    refined = refine(SHIPPED, [drive(60.0)])
    judged = [pair for pair in refined.errors if pair.after.predictions > 100]
    assert judged
    for pair in judged:
        assert pair.after.many_steps < 0.95 * pair.before.many_steps
    sources = [fit.source for fit in refined.bank.provenance.fits]
    assert refined.bank.provenance.source == "recorded"
    assert sources[0] == sources[-1] == "simulated"
    np.testing.assert_array_equal(refined.bank.a[-1], SHIPPED.a[-1])


def test_a_drive_without_excitation_is_refused() -> None:
    with pytest.raises(ModelError, match="the torque moves by 5 Nm of its own"):
        refine(SHIPPED, [drive(0.5)])


def test_a_drive_too_short_for_any_band_is_refused() -> None:
    with pytest.raises(ModelError, match="no band of speed has 500 recorded transitions"):
        refine(SHIPPED, [drive(60.0, runs=1)])


def test_a_drive_of_a_single_block_is_refused() -> None:
    long = drive(60.0, runs=1)
    short = Runs(
        type(long.sample)(*(column[:260] for column in long.sample)),
        long.speed_mps[:260],
        long.command_nm[:259],
    )
    with pytest.raises(ModelError, match="no two blocks of 250 ticks"):
        refine(SHIPPED, [short])


def test_centres_that_do_not_rise_from_above_zero_are_refused() -> None:
    with pytest.raises(ValueError, match="centre_mps"):
        BandSettings(centre_mps=(0.0, 60.0))
