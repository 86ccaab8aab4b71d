"""Where a predictor comes from and where it holds: the metadata of a model file."""

from __future__ import annotations

from pathlib import Path

import msgspec

from tcs_hil.errors import ModelError
from tcs_hil.model.dataset import DatasetSettings, Range
from tcs_hil.model.scaling import Scaling
from tcs_hil.model.vehicle import Positive, Vehicle

LAYOUT_VERSION = 1
"""Of the model file; another number is refused, never guessed at."""


class Validity(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Smallest and largest value of each quantity in the data; nothing is known outside."""

    speed_mps: Range
    slip_ratio: Range
    torque_nm: Range


class FitQuality(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How the regression went, on the data it saw.

    ``residual_rms`` is the one-step error of each observable, in the unit it has
    in z; ``condition_number`` is that of [z, u] with columns of unit length.
    """

    samples: int
    residual_rms: tuple[float, ...]
    condition_number: float


class Provenance(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Everything a predictor is, apart from its matrices: the model file's metadata."""

    layout_version: int = LAYOUT_VERSION
    period_s: Positive
    dictionary: str
    order: int
    scaling: Scaling
    validity: Validity
    fit: FitQuality
    vehicle: Vehicle
    dataset: DatasetSettings
    seed: int


class _Version(msgspec.Struct):
    """The part of the metadata that every layout shares."""

    layout_version: int


def provenance_of(path: Path, metadata: bytes) -> Provenance:
    """Metadata of a known layout; the version is looked at before anything else.

    Raises ModelError naming the file they were read from.
    """
    try:
        version = msgspec.json.decode(metadata, type=_Version).layout_version
        if version == LAYOUT_VERSION:
            return msgspec.json.decode(metadata, type=Provenance)
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise ModelError(f"model file '{path}' has bad metadata: {error}") from error
    raise ModelError(
        f"model file '{path}' has layout {version}, this version reads {LAYOUT_VERSION}"
    )
