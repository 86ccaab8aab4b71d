"""How well a predictor predicts on runs it has not seen; figure 1 of the paper."""

from __future__ import annotations

from typing import NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from tcs_hil.model.dataset import state_at
from tcs_hil.model.predictor import KoopmanPredictor
from tcs_hil.model.tyre import slip_ratio
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.model.wheel import rk4_step, stable_substeps

FloatArray = NDArray[np.float64]

STEPS = 100
SPEED_MPS = 20.0 / 3.6
KAPPA = 0.1
EVALUATION_SEED = 1
"""Other than any seed of identification, so that no torque sequence is met twice."""


class Comparison(NamedTuple):
    """Runs of the true dynamics beside their open-loop predictions; figure 1 is one run."""

    time_s: FloatArray  # (n + 1,)
    torque_nm: FloatArray  # (..., n)
    truth: FloatArray  # (..., n + 1, 3): s in m/s, omega in rad/s, kappa
    prediction: FloatArray  # (..., n + 1, 3)

    def rmse(self) -> FloatArray:
        """Root mean square error (..., 3) over the predicted steps, the known start left out."""
        error = (self.prediction - self.truth)[..., 1:, :]
        rmse: FloatArray = np.sqrt(np.mean(error**2, axis=-2))
        return rmse


class PredictionErrors(msgspec.Struct, frozen=True, kw_only=True):
    """Median open-loop RMSE over random runs, and what tells a sane predictor from another.

    A spectral radius well above 1 means that long predictions run away.
    """

    draws: int
    steps: int
    s_mps: float
    omega_radps: float
    slip_ratio: float
    spectral_radius: float
    condition_number: float


def figure1(predictor: KoopmanPredictor, seed: int = EVALUATION_SEED) -> Comparison:
    """Data of the paper's figure 1: 20 km/h, kappa0 0.1, random two-level torque, 100 steps."""
    levels_nm = predictor.provenance.dataset.torque_nm
    return _compare(predictor, np.random.default_rng(seed).choice(levels_nm, STEPS))


def prediction_errors(
    predictor: KoopmanPredictor, draws: int = 1000, seed: int = EVALUATION_SEED, hold: int = 1
) -> PredictionErrors:
    """Errors of many runs like figure 1; the median of only 40 scatters by 12 %.

    Each torque level is held for ``hold`` periods, a divisor of the steps.
    """
    levels_nm = predictor.provenance.dataset.torque_nm
    levels = np.random.default_rng(seed).choice(levels_nm, (draws, STEPS // hold))
    torque_nm = np.repeat(levels, hold, axis=1)
    s, omega, kappa = np.median(_compare(predictor, torque_nm).rmse(), axis=0)
    return PredictionErrors(
        draws=draws,
        steps=STEPS,
        s_mps=float(s),
        omega_radps=float(omega),
        slip_ratio=float(kappa),
        spectral_radius=float(np.abs(np.linalg.eigvals(predictor.a)).max()),
        condition_number=predictor.provenance.fit.condition_number,
    )


def _compare(predictor: KoopmanPredictor, torque_nm: FloatArray) -> Comparison:
    """Truth and prediction from the start of figure 1 under the same torque (..., n)."""
    vehicle = predictor.provenance.vehicle
    runs = torque_nm.shape[:-1]
    x0 = state_at(np.full(runs, SPEED_MPS), np.full(runs, KAPPA), vehicle)
    return Comparison(
        time_s=np.linspace(0.0, STEPS * predictor.period_s, STEPS + 1),
        torque_nm=torque_nm,
        truth=_simulate(vehicle, x0, torque_nm, predictor.period_s),
        prediction=predictor.predict(x0, torque_nm),
    )


def _simulate(
    vehicle: Vehicle, x0: FloatArray, torque_nm: FloatArray, period_s: float
) -> FloatArray:
    """Trajectory (..., n + 1, 3) of s, omega and kappa by the wheel dynamics."""
    substeps = stable_substeps(vehicle, period_s)
    states = [x0]
    for torque in np.moveaxis(torque_nm, -1, 0):
        states.append(rk4_step(states[-1], torque, vehicle, period_s, substeps))
    s, omega = np.moveaxis(np.stack(states, axis=-2), -1, 0)
    return np.stack((s, omega, slip_ratio(s, omega, vehicle)), axis=-1)
