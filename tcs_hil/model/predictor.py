"""The Koopman predictor z⁺ = A z + B u, with everything needed to use it honestly."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from tcs_hil.errors import ModelError
from tcs_hil.model import archive
from tcs_hil.model.dataset import DatasetSettings
from tcs_hil.model.lifting import (
    SLIP_RATIO,
    SLIP_SPEED,
    WHEEL_SPEED,
    Dictionary,
    Scaling,
    lift,
    make_dictionary,
)
from tcs_hil.model.vehicle import Positive, Vehicle
from tcs_hil.model.wheel import slip_ratio

FloatArray = NDArray[np.float64]
Range = tuple[float, float]

LAYOUT_VERSION = 1


class Validity(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Smallest and largest value of each quantity in the data; nothing is known outside."""

    speed_mps: Range
    slip_ratio: Range
    torque_nm: Range


class FitQuality(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How well the regression went, on the data it saw.

    ``residual_rms`` is the one-step error of each lifted state, in its own
    scaled unit; ``gram_condition`` is the condition number of the normal
    equations that the solver avoids, i.e. the square of the regressor's.
    """

    samples: int
    residual_rms: tuple[float, ...]
    gram_condition: float


class Identity(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What a predictor is made of and what it was made from; a model file's metadata."""

    layout_version: int = LAYOUT_VERSION
    dictionary: str
    order: int
    period_s: Positive
    scaling: Scaling
    validity: Validity
    fit: FitQuality
    vehicle: Vehicle
    dataset: DatasetSettings
    seed: int


@dataclass(frozen=True, eq=False)
class KoopmanPredictor:
    """Linear prediction of the lifted state over one period.

    z is scaled as ``identity.scaling`` says and begins with [s, omega, kappa];
    u is the scaled motor torque.  ``c`` selects these three from z.
    """

    a: FloatArray  # (nz, nz)
    b: FloatArray  # (nz, 1)
    c: FloatArray  # (3, nz)
    dictionary: Dictionary
    identity: Identity

    slip_index = SLIP_RATIO

    @property
    def nz(self) -> int:
        """Length of the lifted state."""
        return self.dictionary.size

    @property
    def period_s(self) -> float:
        """Sampling time of the prediction in seconds."""
        return self.identity.period_s

    def lift(self, s_mps: Any, omega_radps: Any) -> FloatArray:
        """Lifted state (nz,) of one wheel given as floats, or (n, nz) of columns (n,)."""
        return lift_state(self.dictionary, self.identity.scaling, self.identity.vehicle, s_mps, omega_radps)
