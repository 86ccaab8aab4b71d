"""From excited cars to a Koopman bank: one ridge regression per band of speed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tcs_hil.model.bank import KoopmanBank
from tcs_hil.model.bank_provenance import BandFit, BandSettings, BankProvenance, BankSettings
from tcs_hil.model.dataset import Progress
from tcs_hil.model.excitation import Transitions, excite, log_uniform, transitions
from tcs_hil.model.fleet import Fleet
from tcs_hil.model.observables import NZ, Observable
from tcs_hil.model.provenance import Validity
from tcs_hil.model.ranges import Range, range_of

FloatArray = NDArray[np.float64]

BANK_SEED = 2025
"""Of the bank shipped with the package."""

RIDGE = 1e-8
"""Relative to columns of unit length: it settles what the data leave open, and nothing else."""

LEARNT = [
    Observable.SLIP_SPEED,
    Observable.WHEEL_SPEED,
    Observable.SLIP_RATIO,
    Observable.TYRE,
    Observable.TWIST_RATE,
    Observable.MOTOR_CHANGE,
    Observable.TORQUE,
]
KNOWN = {
    Observable.TWIST_RATE_BEFORE: Observable.TWIST_RATE,
    Observable.TORQUE_BEFORE: Observable.TORQUE,
    Observable.ONE: Observable.ONE,
}
"""Rows of A that need no data: what stands in z one period later."""


class Band(NamedTuple):
    """One predictor and how it was fitted."""

    a: FloatArray  # (NZ, NZ)
    b: FloatArray  # (NZ,)
    fit: BandFit
    validity: Validity


def identify_bank(
    settings: BankSettings, seed: int = BANK_SEED, progress: Progress | None = None
) -> KoopmanBank:
    """Simulate, lift and fit every band; about three seconds.  The same seed, the same bank."""
    rng = np.random.default_rng(seed)
    bands = []
    for band in range(settings.bands.count):
        bands.append(fit_band(simulate_band(settings, band, rng)))
        if progress is not None:
            progress(len(bands) / settings.bands.count)
    return assemble(bands, settings, seed)


def simulate_band(settings: BankSettings, band: int, rng: np.random.Generator) -> Transitions:
    """Transitions of a new fleet around one speed, within the slip the bands are fitted to."""
    runs = settings.excitation.runs
    start_mps = log_uniform(settings.bands.reach_mps(band), runs, rng)
    fleet = Fleet.draw(settings.vehicle, settings.fleet, runs, rng)
    driven = excite(fleet, settings.excitation, start_mps, settings.period_s, rng)
    return usable(transitions(driven, settings.vehicle), settings.bands)


def usable(data: Transitions, bands: BandSettings) -> Transitions:
    """The transitions that neither begin nor end outside the slip of ``bands``."""
    low, high = bands.slip_ratio
    slips = np.stack((data.z[:, Observable.SLIP_RATIO], data.z_next[:, Observable.SLIP_RATIO]))
    return data.where(np.asarray((slips.min(axis=0) >= low) & (slips.max(axis=0) <= high)))


def fit_band(data: Transitions, prior: FloatArray | None = None, ridge: float = RIDGE) -> Band:
    """Regression of z_next on [z, u], drawn towards ``prior`` (NZ + 1, NZ) where given."""
    regressor = np.column_stack((data.z, data.u))  # (n, NZ + 1)
    length = np.linalg.norm(regressor, axis=0)
    length[length == 0.0] = 1.0
    unit = regressor / length
    solution = np.zeros((NZ + 1, NZ)) if prior is None else prior.copy()
    error = data.z_next - regressor @ solution
    gram = unit.T @ unit + ridge * np.eye(NZ + 1)
    solution += np.linalg.solve(gram, unit.T @ error) / length[:, np.newaxis]
    a, b = _with_known_rows(solution)
    residual = data.z_next[:, Observable.SLIP_RATIO] - (
        data.z @ a[Observable.SLIP_RATIO] + data.u * b[Observable.SLIP_RATIO]
    )
    return Band(a, b, _band_fit(data, residual), _validity(data))


def assemble(bands: list[Band], settings: BankSettings, seed: int) -> KoopmanBank:
    """A bank of bands in the order of their centres; recorded if one of them is."""
    fits = tuple(band.fit for band in bands)
    provenance = BankProvenance(
        source="recorded" if any(fit.source == "recorded" for fit in fits) else "simulated",
        settings=settings,
        validity=_joint([band.validity for band in bands]),
        fits=fits,
        seed=seed,
    )
    arrays = {
        "a": np.stack([band.a for band in bands]),
        "b": np.stack([band.b for band in bands]),
        "centre_mps": settings.bands.centres_mps(),
    }
    return KoopmanBank.build(arrays, provenance)


def _with_known_rows(solution: FloatArray) -> tuple[FloatArray, FloatArray]:
    a, b = np.zeros((NZ, NZ)), np.zeros(NZ)
    a[LEARNT], b[LEARNT] = solution[:NZ].T[LEARNT], solution[NZ][LEARNT]
    for later, now in KNOWN.items():
        a[later, now] = 1.0
    return a, b


def _band_fit(data: Transitions, residual: FloatArray) -> BandFit:
    return BandFit(
        source="simulated",
        samples=len(data.u),
        speed_mps=_range(data.speed_mps),
        slip_residual_rms=float(np.sqrt(np.mean(residual**2))),
    )


def _validity(data: Transitions) -> Validity:
    return Validity(
        speed_mps=_range(data.speed_mps),
        slip_ratio=_range(data.z[:, Observable.SLIP_RATIO]),
        torque_nm=_range(data.u),
    )


def _joint(validities: list[Validity]) -> Validity:
    """What at least one band has seen: neighbours overlap, so nothing lies between them."""

    def joint(name: str) -> Range:
        return range_of([bound for validity in validities for bound in getattr(validity, name)])

    return Validity(
        speed_mps=joint("speed_mps"), slip_ratio=joint("slip_ratio"), torque_nm=joint("torque_nm")
    )


def _range(values: FloatArray) -> Range:
    return float(values.min()), float(values.max())
