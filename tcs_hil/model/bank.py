"""A bank of Koopman predictors over vehicle speed, interpolated between neighbours."""

from __future__ import annotations

import math
from bisect import bisect_left
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np
from numpy.typing import NDArray

from tcs_hil.errors import ModelError
from tcs_hil.model import archive
from tcs_hil.model.bank_provenance import BankProvenance
from tcs_hil.model.observables import NZ
from tcs_hil.model.provenance import Validity, check_period, provenance_of

FloatArray = NDArray[np.float64]

Share = tuple[int, float]
"""A band and its weight."""


@dataclass(frozen=True, eq=False)
class KoopmanBank:
    """Predictors z⁺ = A z + B u, one per band of vehicle speed, over the same lifted state.

    z is that of `tcs_hil.model.observables`, u the motor torque in Nm that acts
    from now on: transport delay is not in here, a controller rolls it out.
    Between the centres of two bands both predict and are mixed by the logarithm
    of the speed, so that nothing jumps at a border.
    """

    a: FloatArray  # (bands, NZ, NZ)
    b: FloatArray  # (bands, NZ)
    centre_mps: tuple[float, ...]
    provenance: BankProvenance

    @classmethod
    def build(cls, arrays: dict[str, FloatArray], provenance: BankProvenance) -> KoopmanBank:
        """Check that arrays ``a``, ``b`` and ``centre_mps`` fit together.  Raises ModelError."""
        if arrays.keys() != {"a", "b", "centre_mps"}:
            raise ModelError(f"it holds {sorted(arrays)} instead of a, b and centre_mps")
        a, b, centre = arrays["a"], arrays["b"], arrays["centre_mps"]
        bands = centre.size
        if a.shape != (bands, NZ, NZ) or b.shape != (bands, NZ) or bands == 0:
            raise ModelError(
                f"A {a.shape} and B {b.shape} do not fit {bands} bands of {NZ} observables"
            )
        if not all(np.isfinite(array).all() for array in arrays.values()):
            raise ModelError("an array is not finite")
        if centre.min() <= 0.0 or (np.diff(centre) <= 0.0).any():
            raise ModelError("the centres of the bands do not rise from above zero")
        return cls(a, b, tuple(centre.tolist()), provenance)

    @property
    def period_s(self) -> float:
        """Sampling time in seconds."""
        return self.provenance.period_s

    @property
    def validity(self) -> Validity:
        """Range of the data behind the bank; nothing is known outside."""
        return self.provenance.validity

    def shares(self, speed_mps: float) -> tuple[Share, ...]:
        """The one or two bands that predict at a speed; their weights add up to 1."""
        centre = self.centre_mps
        upper = bisect_left(centre, speed_mps)
        if upper == 0:
            return ((0, 1.0),)
        if upper == len(centre):
            return ((upper - 1, 1.0),)
        below, above = centre[upper - 1], centre[upper]
        weight = math.log(speed_mps / below) / math.log(above / below)
        return (upper - 1, 1.0 - weight), (upper, weight)

    def matrices(self, speed_mps: float) -> tuple[FloatArray, FloatArray]:
        """A (NZ, NZ) and B (NZ,) at a speed."""
        shares = self.shares(speed_mps)
        a = sum(weight * self.a[band] for band, weight in shares)
        b = sum(weight * self.b[band] for band, weight in shares)
        return np.asarray(a), np.asarray(b)

    def predict(self, z: FloatArray, torques_nm: FloatArray, speed_mps: float) -> FloatArray:
        """Lifted states (..., n + 1, NZ) from z (..., NZ) under torques (..., n)."""
        a, b = self.matrices(speed_mps)
        trajectory = [z]
        for torque in np.moveaxis(torques_nm, -1, 0):
            trajectory.append(trajectory[-1] @ a.T + torque[..., np.newaxis] * b)
        return np.stack(trajectory, axis=-2)

    def save(self, path: Path) -> None:
        """Write the model file; the same bank gives the same bytes.  Raises ModelError."""
        metadata = msgspec.json.format(msgspec.json.encode(self.provenance))
        arrays = {"a": self.a, "b": self.b, "centre_mps": np.array(self.centre_mps)}
        archive.write(path, metadata, arrays)

    @classmethod
    def load(cls, path: Path, period_s: float) -> KoopmanBank:
        """Read a model file made for this sampling time.  Raises ModelError naming the file."""
        metadata, arrays = archive.read(path)
        provenance = provenance_of(path, metadata, BankProvenance, "bank")
        check_period(path, provenance.period_s, period_s)
        try:
            return cls.build(arrays, provenance)
        except ModelError as error:
            raise ModelError(f"model file '{path}' is inconsistent: {error}") from error


def default_bank_path() -> Path:
    """The bank identified with the default settings and seed, shipped in the package."""
    return Path(__file__).with_name("default.npz")


def slippery_bank_path() -> Path:
    """The same for a third of the grip (``friction_ratio`` 0.097 to 0.103), shipped with it."""
    return Path(__file__).with_name("slippery.npz")
