"""How well a bank predicts on runs it has not seen, by speed."""

from __future__ import annotations

from itertools import pairwise

import msgspec
import numpy as np
from numpy.typing import NDArray

from tcs_hil.model.bank import KoopmanBank
from tcs_hil.model.excitation import Runs, excite, log_uniform
from tcs_hil.model.fleet import Fleet
from tcs_hil.model.observables import Observable, Sample, lift
from tcs_hil.model.ranges import Range

FloatArray = NDArray[np.float64]

STEPS = 10
"""Periods predicted open loop: what the controller looks ahead, less its delay."""

BIN_EDGES_MPS = (0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 40.0, 60.0)
EVALUATION_SEED = 1
"""Other than any seed of identification, so that no car and no torque is met twice."""
RUNS_PER_BIN = 60


class BinError(msgspec.Struct, frozen=True, kw_only=True):
    """Root mean square errors within one bin of speed; NaN without data.

    ``one_step`` and ``many_steps`` are of the slip ratio after 1 and `STEPS`
    periods; ``held`` is what predicting "no change" would err after as many.
    """

    speed_mps: Range
    predictions: int
    one_step: float
    many_steps: float
    held: float


def simulated_errors(bank: KoopmanBank, seed: int = EVALUATION_SEED) -> list[BinError]:
    """Errors by speed on a new fleet in every bin."""
    rng = np.random.default_rng(seed)
    return [_simulated(bank, edges, rng) for edges in pairwise(BIN_EDGES_MPS)]


def errors_of(bank: KoopmanBank, runs: Runs, edges_mps: Range) -> BinError:
    """Errors of every prediction that starts in a bin of speed and stays in the bank's slip."""
    z = lift(
        Sample(*(column[1:] for column in runs.sample)),
        Sample(*(column[:-1] for column in runs.sample)),
        bank.provenance.settings.vehicle,
    )  # (T, n, NZ)
    pieces = [
        piece
        for start in range(0, len(z) - STEPS, STEPS)
        for piece in _predictions(bank, z, runs, start, edges_mps)
    ]
    if not pieces:
        return BinError(
            speed_mps=edges_mps, predictions=0, one_step=np.nan, many_steps=np.nan, held=np.nan
        )
    truth, prediction = (np.stack(part) for part in zip(*pieces, strict=True))  # (m, STEPS + 1)
    error = prediction - truth
    return BinError(
        speed_mps=edges_mps,
        predictions=len(truth),
        one_step=_rms(error[:, 1]),
        many_steps=_rms(error[:, STEPS]),
        held=_rms(truth[:, STEPS] - truth[:, 0]),
    )


def _simulated(bank: KoopmanBank, edges_mps: Range, rng: np.random.Generator) -> BinError:
    settings = bank.provenance.settings
    start_mps = log_uniform(edges_mps, RUNS_PER_BIN, rng)
    fleet = Fleet.draw(settings.vehicle, settings.fleet, RUNS_PER_BIN, rng)
    runs = excite(fleet, settings.excitation, start_mps, settings.period_s, rng)
    return errors_of(bank, runs, edges_mps)


def _predictions(
    bank: KoopmanBank, z: FloatArray, runs: Runs, start: int, edges_mps: Range
) -> list[tuple[FloatArray, FloatArray]]:
    """True and predicted slip (STEPS + 1,) of each run from one instant on."""
    low, high = bank.validity.slip_ratio
    truth = z[start : start + STEPS + 1, :, Observable.SLIP_RATIO]  # (STEPS + 1, n)
    speed = runs.speed_mps[start + 1]
    judged = (truth.min(axis=0) >= low) & (truth.max(axis=0) <= high)
    judged &= (speed >= edges_mps[0]) & (speed < edges_mps[1])
    torques = runs.command_nm[start + 1 : start + 1 + STEPS]
    return [
        (truth[:, run], _slip(bank.predict(z[start, run], torques[:, run], float(speed[run]))))
        for run in np.flatnonzero(judged)
    ]


def _slip(trajectory: FloatArray) -> FloatArray:
    return np.asarray(trajectory[:, Observable.SLIP_RATIO])


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))
