"""Where a predictor comes from and where it holds: the metadata of a model file."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Literal, TypeVar

import msgspec

from tcs_hil.errors import ModelError
from tcs_hil.model.dataset import DatasetSettings
from tcs_hil.model.radial import Centres
from tcs_hil.model.ranges import Range
from tcs_hil.model.scaling import Scaling
from tcs_hil.model.vehicle import Positive, Vehicle

LAYOUT_VERSION = 2
"""Of the model file; another number is refused, never guessed at."""

Source = Literal["simulated", "recorded"]
T = TypeVar("T")


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
    """Everything a predictor is, apart from its arrays: the model file's metadata."""

    layout_version: int = LAYOUT_VERSION
    kind: Literal["predictor"] = "predictor"
    source: Source = "simulated"
    period_s: Positive
    dictionary: str
    order: int
    centres: Centres = ()
    scaling: Scaling
    validity: Validity
    fit: FitQuality
    vehicle: Vehicle
    dataset: DatasetSettings
    seed: int


class _Header(msgspec.Struct):
    """The part of the metadata that every layout shares."""

    layout_version: int
    kind: str = "predictor"


def kind_of(path: Path, metadata: bytes) -> str:
    """``predictor`` or ``bank``, of a known layout; looked at before anything else.

    Raises ModelError naming the file they were read from.
    """
    try:
        header = msgspec.json.decode(metadata, type=_Header)
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise ModelError(f"model file '{path}' has bad metadata: {error}") from error
    if header.layout_version != LAYOUT_VERSION:
        raise ModelError(
            f"model file '{path}' has layout {header.layout_version}, "
            f"this version reads {LAYOUT_VERSION}"
        )
    return header.kind


def provenance_of(path: Path, metadata: bytes, struct: type[T], kind: str) -> T:
    """Metadata of a known layout and the wanted kind as a ``struct``.

    Raises ModelError naming the file they were read from.
    """
    found = kind_of(path, metadata)
    if found != kind:
        raise ModelError(f"model file '{path}' holds a {found}, but a {kind} is needed")
    try:
        return msgspec.json.decode(metadata, type=struct)
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise ModelError(f"model file '{path}' has bad metadata: {error}") from error


def check_period(path: Path, made_for_s: float, period_s: float) -> None:
    """Raise ModelError for a model made for another sampling time."""
    if not math.isclose(made_for_s, period_s):
        raise ModelError(f"model file '{path}' is for a period of {made_for_s} s, not {period_s} s")
