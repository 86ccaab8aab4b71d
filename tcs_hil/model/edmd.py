"""Extended dynamic mode decomposition: the predictor that fits a data set best in one step."""

from __future__ import annotations

from typing import NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from tcs_hil.errors import ModelError
from tcs_hil.model.dataset import Dataset, DatasetSettings, Progress, generate
from tcs_hil.model.lifting import DICTIONARIES, SLIP_RATIO, Lifting, make_dictionary
from tcs_hil.model.predictor import KoopmanPredictor
from tcs_hil.model.provenance import FitQuality, Provenance, Validity
from tcs_hil.model.radial import KERNELS, Centres, centre_count, draw_centres
from tcs_hil.model.scaling import Scaling, fit_scaling
from tcs_hil.model.vehicle import Vehicle

FloatArray = NDArray[np.float64]

DEFAULT_SEED = 2024
"""Of the model shipped with the package."""


class IdentificationSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What to identify from what; the defaults are the paper's."""

    vehicle: Vehicle = Vehicle()
    dataset: DatasetSettings = DatasetSettings()
    dictionary: str = "monomials"
    order: int = 4


class Regression(NamedTuple):
    """Solution of Eq. (koop_id_ab)."""

    a: FloatArray  # (nz, nz)
    b: FloatArray  # (nz, nu)
    quality: FitQuality


def fit(z: FloatArray, u: FloatArray, z_next: FloatArray) -> Regression:
    """Least squares z_next ≈ A z + B u over rows z, z_next (n, nz) and u (n, nu).

    Solved by singular values with columns of unit length: high monomials are
    thousands of times larger than kappa, and normal equations would square that.
    Raises ModelError when the data leave A and B undetermined.
    """
    regressor = np.hstack((z, u))
    if not (np.isfinite(regressor).all() and np.isfinite(z_next).all()):
        raise ModelError("the data set runs away: speeds or torques are beyond any car's")
    length = np.linalg.norm(regressor, axis=0)
    length[length == 0.0] = 1.0
    scaled_solution, _, rank, singular = np.linalg.lstsq(regressor / length, z_next)
    if rank < length.size:
        raise ModelError(f"the data set excites {rank} of {length.size} directions of [z, u]")
    solution: FloatArray = np.asarray(scaled_solution / length[:, np.newaxis], np.float64)
    residual_rms = np.sqrt(np.mean((z_next - regressor @ solution) ** 2, axis=0))
    quality = FitQuality(
        samples=len(z),
        residual_rms=tuple(residual_rms.tolist()),
        condition_number=float(singular[0] / singular[-1]),
    )
    nz = z.shape[1]
    return Regression(solution[:nz].T.copy(), solution[nz:].T.copy(), quality)


def identify(
    settings: IdentificationSettings, seed: int = DEFAULT_SEED, progress: Progress | None = None
) -> KoopmanPredictor:
    """Simulate the data set, lift it and fit the predictor; about a second.

    Raises ModelError for an unknown dictionary or data that determine nothing.
    """
    if settings.dictionary not in DICTIONARIES:  # said before a data set is simulated
        make_dictionary(settings.dictionary, settings.order)
    data = generate(settings.vehicle, settings.dataset, seed, progress)
    scaling = fit_scaling(*data)
    centres = _centres(settings, data, scaling, seed)
    dictionary = make_dictionary(settings.dictionary, settings.order, centres)
    lifting = Lifting(dictionary, scaling, settings.vehicle)
    z, z_next = lifting.lift(*data.x.T), lifting.lift(*data.x_next.T)
    regression = fit(z, lifting.scaling.scale_torque(data.u), z_next)
    provenance = Provenance(
        period_s=settings.dataset.period_s,
        dictionary=settings.dictionary,
        order=settings.order,
        centres=centres,
        scaling=lifting.scaling,
        validity=_validity(data, settings.vehicle, z[:, SLIP_RATIO]),
        fit=regression.quality,
        vehicle=settings.vehicle,
        dataset=settings.dataset,
        seed=seed,
    )
    return KoopmanPredictor.build(regression.a, regression.b, provenance)


def _centres(
    settings: IdentificationSettings, data: Dataset, scaling: Scaling, seed: int
) -> Centres:
    if settings.dictionary not in KERNELS:
        return ()
    s, omega = data.x.T
    states = np.column_stack((scaling.scale_s(s), scaling.scale_omega(omega)))
    return draw_centres(states, centre_count(settings.order), seed)


def _validity(data: Dataset, vehicle: Vehicle, kappa: FloatArray) -> Validity:
    s, omega = data.x.T
    return Validity(
        speed_mps=_range(omega * vehicle.wheel_radius_m - s),
        slip_ratio=_range(kappa),
        torque_nm=_range(data.u),
    )


def _range(values: FloatArray) -> tuple[float, float]:
    return float(values.min()), float(values.max())
