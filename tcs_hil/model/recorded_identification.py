"""A bank refined on recorded drives: what they excite is learnt, the rest stays as simulated."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from tcs_hil.errors import ModelError
from tcs_hil.model.bank import KoopmanBank
from tcs_hil.model.bank_evaluation import BIN_EDGES_MPS, BinError, errors_of
from tcs_hil.model.bank_identification import Band, assemble, fit_band, usable
from tcs_hil.model.excitation import Runs, Transitions, transitions
from tcs_hil.model.observables import Sample

FloatArray = NDArray[np.float64]

BLOCK_SAMPLES = 250
HELD_BACK = 4
"""Of every four blocks (of half a second) one is kept for judging."""

MIN_SAMPLES = 500
"""Transitions below which a band is left as it was simulated."""

MIN_EXCITATION_NM = 5.0
"""Torque, as a standard deviation, that the lifted state does not explain.

Under quiet control the torque is a function of the state: such data fit any
predictor, and a controller built on the wrong one stalls the car.
"""

PRIOR_WEIGHT = 0.1
"""Ridge, relative to columns of unit length, that draws the regression to the simulated bank."""


class Judged(NamedTuple):
    """Errors within one bin of speed on blocks no regression has seen, before and after."""

    before: BinError
    after: BinError


class Refined(NamedTuple):
    """The new bank and how it does."""

    bank: KoopmanBank
    errors: list[Judged]


def refine(bank: KoopmanBank, drives: list[Runs]) -> Refined:
    """Fit every band that the drives cover, starting from ``bank``.

    Raises ModelError if they cover none.
    """
    blocks = [block for drive in drives for block in _blocks(drive)]
    seen = [block for index, block in enumerate(blocks) if index % HELD_BACK]
    unseen = blocks[::HELD_BACK]
    if not seen:
        raise ModelError(f"the recorded drives hold no two blocks of {BLOCK_SAMPLES} ticks")
    settings = bank.provenance.settings
    data = [usable(transitions(block, settings.vehicle), settings.bands) for block in seen]
    bands = [_band(bank, index, data) for index in range(len(bank.centre_mps))]
    if not any(band.fit.source == "recorded" for band in bands):
        raise ModelError(
            f"no band of speed has {MIN_SAMPLES} recorded transitions in which the torque moves by "
            f"{MIN_EXCITATION_NM:.0f} Nm of its own"
        )
    refined = assemble(bands, settings, bank.provenance.seed)
    return Refined(refined, _judge(bank, refined, unseen))


def _band(bank: KoopmanBank, index: int, data: list[Transitions]) -> Band:
    low, high = bank.provenance.settings.bands.reach_mps(index)
    near = [part.where((part.speed_mps >= low) & (part.speed_mps <= high)) for part in data]
    joint = Transitions(*(np.concatenate(columns) for columns in zip(*near, strict=True)))
    if len(joint.u) < MIN_SAMPLES or excitation_nm(joint) < MIN_EXCITATION_NM:
        fit = bank.provenance.fits[index]
        return Band(bank.a[index], bank.b[index], fit, bank.validity)
    prior = np.vstack((bank.a[index].T, bank.b[index]))
    band = fit_band(joint, prior, PRIOR_WEIGHT)
    return band._replace(fit=msgspec.structs.replace(band.fit, source="recorded"))


def excitation_nm(data: Transitions) -> float:
    """Standard deviation of the torque around its regression on the state."""
    length = np.linalg.norm(data.z, axis=0)
    length[length == 0.0] = 1.0
    explained, *_ = np.linalg.lstsq(data.z / length, data.u)
    return float(np.std(data.u - data.z / length @ explained))


def _judge(before: KoopmanBank, after: KoopmanBank, blocks: list[Runs]) -> list[Judged]:
    together = _side_by_side(blocks)
    return [
        Judged(errors_of(before, together, edges), errors_of(after, together, edges))
        for edges in pairwise(BIN_EDGES_MPS)
    ]


def _blocks(drive: Runs) -> Iterator[Runs]:
    """Consecutive pieces of equal length; what is left over at the end is not used."""
    for start in range(0, len(drive.command_nm) - BLOCK_SAMPLES + 1, BLOCK_SAMPLES):
        instants = slice(start, start + BLOCK_SAMPLES + 1)
        yield Runs(
            Sample(*(column[instants] for column in drive.sample)),
            drive.speed_mps[instants],
            drive.command_nm[start : start + BLOCK_SAMPLES],
        )


def _side_by_side(blocks: list[Runs]) -> Runs:
    samples = zip(*(block.sample for block in blocks), strict=True)
    return Runs(
        Sample(*(np.concatenate(columns, axis=1) for columns in samples)),
        np.concatenate([block.speed_mps for block in blocks], axis=1),
        np.concatenate([block.command_nm for block in blocks], axis=1),
    )
