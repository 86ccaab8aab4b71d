"""The Koopman bank: its bands, its file, and the one that is shipped."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tcs_hil.errors import ModelError
from tcs_hil.model import archive
from tcs_hil.model.bank import KoopmanBank, default_bank_path, slippery_bank_path
from tcs_hil.model.bank_identification import BANK_SEED, identify_bank
from tcs_hil.model.bank_provenance import BankSettings
from tcs_hil.model.fleet import FleetSettings
from tcs_hil.model.observables import NZ, Observable
from tcs_hil.model.predictor import KoopmanPredictor, default_model_path

PERIOD_S = 0.002
SHIPPED = KoopmanBank.load(default_bank_path(), PERIOD_S)


@given(st.floats(0.0, 100.0))
def test_the_shares_of_neighbouring_bands_add_up_to_one(speed_mps: float) -> None:
    shares = SHIPPED.shares(speed_mps)
    assert sum(weight for _, weight in shares) == pytest.approx(1.0)
    assert all(0.0 <= weight <= 1.0 for _, weight in shares)
    assert len(shares) == 1 or shares[1][0] == shares[0][0] + 1


@pytest.mark.parametrize("band", range(len(SHIPPED.centre_mps)))
def test_at_its_centre_a_band_predicts_alone_and_nothing_jumps_there(band: int) -> None:
    centre_mps = SHIPPED.centre_mps[band]
    a, b = SHIPPED.matrices(centre_mps)
    np.testing.assert_allclose(a, SHIPPED.a[band], rtol=1e-12, atol=1e-12)
    for nearby in (centre_mps * (1 - 1e-9), centre_mps * (1 + 1e-9)):
        np.testing.assert_allclose(SHIPPED.matrices(nearby)[0], a, rtol=1e-6, atol=1e-6)
        np.testing.assert_allclose(SHIPPED.matrices(nearby)[1], b, rtol=1e-6, atol=1e-6)


def test_a_prediction_is_the_linear_recursion_at_one_speed() -> None:
    rng = np.random.default_rng(2)
    z, torques = rng.normal(size=(3, NZ)), rng.uniform(0.0, 200.0, (3, 4))
    a, b = SHIPPED.matrices(4.0)
    last = z
    for k in range(4):
        last = last @ a.T + torques[:, [k]] * b
    np.testing.assert_allclose(SHIPPED.predict(z, torques, 4.0)[:, -1], last, rtol=1e-12)


def test_the_shipped_bank_is_what_identification_makes() -> None:
    bank = identify_bank(BankSettings())
    # Another BLAS may round differently; 1e-7 leaves room for that and nothing else.
    np.testing.assert_allclose(SHIPPED.a, bank.a, rtol=1e-7, atol=1e-7)
    np.testing.assert_allclose(SHIPPED.b, bank.b, rtol=1e-7, atol=1e-7)
    assert SHIPPED.provenance.seed == BANK_SEED
    assert SHIPPED.provenance.source == "simulated"


def test_the_bank_for_ice_is_the_same_with_a_third_of_the_grip() -> None:
    slippery = KoopmanBank.load(slippery_bank_path(), PERIOD_S)
    settings = BankSettings(fleet=FleetSettings(friction_ratio=(0.097, 0.103)))
    assert slippery.provenance.settings == settings
    bank = identify_bank(settings)
    np.testing.assert_allclose(slippery.a, bank.a, rtol=1e-7, atol=1e-7)
    np.testing.assert_allclose(slippery.b, bank.b, rtol=1e-7, atol=1e-7)


def test_the_shipped_bank_is_valid_from_standstill_to_200_kmph_and_small() -> None:
    low, high = SHIPPED.validity.speed_mps
    assert low < 0.05
    assert high > 200.0 / 3.6
    assert default_bank_path().stat().st_size < 50_000


def test_more_torque_means_more_slip_in_every_band() -> None:
    z = np.zeros(NZ)
    pulse = np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    for speed_mps in SHIPPED.centre_mps:
        assert SHIPPED.predict(z, pulse, speed_mps)[-1, Observable.SLIP_RATIO] > 0.0


def test_saving_and_loading_changes_nothing(tmp_path: Path) -> None:
    SHIPPED.save(tmp_path / "copy.npz")
    assert (tmp_path / "copy.npz").read_bytes() == default_bank_path().read_bytes()
    assert KoopmanBank.load(tmp_path / "copy.npz", PERIOD_S).provenance == SHIPPED.provenance


def test_another_sampling_time_is_refused() -> None:
    with pytest.raises(ModelError, match=r"is for a period of 0\.002 s, not 0\.005 s"):
        KoopmanBank.load(default_bank_path(), 0.005)


def test_a_bank_is_no_predictor_and_a_predictor_no_bank() -> None:
    with pytest.raises(ModelError, match="holds a predictor, but a bank is needed"):
        KoopmanBank.load(default_model_path(), PERIOD_S)
    with pytest.raises(ModelError, match="holds a bank, but a predictor is needed"):
        KoopmanPredictor.load(default_bank_path(), PERIOD_S)


def test_the_layout_of_an_older_version_is_refused(tmp_path: Path) -> None:
    metadata, arrays = archive.read(default_model_path())
    old = msgspec.json.decode(metadata) | {"layout_version": 1}
    archive.write(tmp_path / "old.npz", msgspec.json.encode(old), arrays)
    with pytest.raises(ModelError, match="has layout 1, this version reads 2"):
        KoopmanPredictor.load(tmp_path / "old.npz", PERIOD_S)


@pytest.mark.parametrize(
    ("spoilt", "complaint"),
    [
        ({"a": SHIPPED.a[:3]}, "do not fit 10 bands"),
        ({"b": SHIPPED.b * np.nan}, "not finite"),
        ({"centre_mps": -np.arange(10.0)}, "do not rise"),
        ({"c": SHIPPED.b}, "instead of a, b and centre_mps"),
    ],
)
def test_arrays_that_make_no_bank_are_refused(
    spoilt: dict[str, np.ndarray], complaint: str, tmp_path: Path
) -> None:
    metadata, arrays = archive.read(default_bank_path())
    archive.write(tmp_path / "bad.npz", metadata, arrays | spoilt)
    with pytest.raises(ModelError, match=rf"bad\.npz' is inconsistent: .*{complaint}"):
        KoopmanBank.load(tmp_path / "bad.npz", PERIOD_S)
