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
from tcs_hil.model.lifting import SLIP_RATIO, Lifting, make_dictionary
from tcs_hil.model.provenance import Provenance, Validity, check_period, provenance_of
from tcs_hil.model.scaling import Scaling

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class KoopmanPredictor:
    """Linear prediction of the lifted state over one period, Eq. (koop_lti).

    z begins with [scaled s, scaled omega, kappa]; u is the scaled motor torque.
    """

    a: FloatArray  # (nz, nz)
    b: FloatArray  # (nz, 1)
    provenance: Provenance
    lifting: Lifting

    @classmethod
    def build(cls, a: FloatArray, b: FloatArray, provenance: Provenance) -> KoopmanPredictor:
        """Check the shapes against the dictionary.  Raises ModelError."""
        dictionary = make_dictionary(provenance.dictionary, provenance.order, provenance.centres)
        nz = dictionary.size
        if a.shape != (nz, nz) or b.shape != (nz, 1):
            raise ModelError(f"A {a.shape} and B {b.shape} do not fit {nz} observables")
        if not (np.isfinite(a).all() and np.isfinite(b).all()):
            raise ModelError("A or B is not finite")
        return cls(a, b, provenance, Lifting(dictionary, provenance.scaling, provenance.vehicle))

    @property
    def nz(self) -> int:
        """Length of the lifted state."""
        return self.lifting.dictionary.size

    @property
    def c(self) -> FloatArray:
        """Selection (3, nz) of [scaled s, scaled omega, kappa] from z, set by hand."""
        return np.eye(3, self.nz)

    @property
    def slip_index(self) -> int:
        """Where kappa stands in z."""
        return SLIP_RATIO

    @property
    def period_s(self) -> float:
        """Sampling time in seconds."""
        return self.provenance.period_s

    @property
    def scaling(self) -> Scaling:
        """Scaling of s, omega and the torque."""
        return self.provenance.scaling

    @property
    def validity(self) -> Validity:
        """Range of the data behind the predictor."""
        return self.provenance.validity

    def lift(self, s_mps: Any, omega_radps: Any) -> FloatArray:
        """Lifted state (nz,) of one state given as floats, or (n, nz) of columns (n,)."""
        return self.lifting.lift(s_mps, omega_radps)

    def scale_input(self, torque_nm: Any) -> Any:
        """Motor torque in the unit in which B takes it."""
        return self.scaling.scale_torque(torque_nm)

    def predict(self, x0: FloatArray, torques_nm: FloatArray) -> FloatArray:
        """Trajectory (..., n + 1, 3) of s in m/s, omega in rad/s and kappa.

        It starts at ``x0`` (..., 2), [s, omega]; the ``torques_nm`` (..., n) are
        held one period each.
        """
        z = self.lift(x0[..., 0], x0[..., 1])
        trajectory = [z]
        for u in np.moveaxis(self.scale_input(torques_nm), -1, 0):
            z = z @ self.a.T + u[..., np.newaxis] * self.b[:, 0]
            trajectory.append(z)
        s, omega, kappa = np.moveaxis(np.stack(trajectory, axis=-2)[..., :3], -1, 0)
        return np.stack((self.scaling.unscale_s(s), self.scaling.unscale_omega(omega), kappa), -1)

    def save(self, path: Path) -> None:
        """Write the model file; the same predictor gives the same bytes.  Raises ModelError."""
        metadata = msgspec.json.format(msgspec.json.encode(self.provenance))
        archive.write(path, metadata, {"a": self.a, "b": self.b})

    @classmethod
    def load(cls, path: Path, period_s: float) -> KoopmanPredictor:
        """Read a model file made for this sampling time.  Raises ModelError naming the file."""
        metadata, arrays = archive.read(path)
        provenance = provenance_of(path, metadata, Provenance, "predictor")
        check_period(path, provenance.period_s, period_s)
        if arrays.keys() != {"a", "b"}:
            raise ModelError(f"model file '{path}' holds {sorted(arrays)} instead of a and b")
        try:
            return cls.build(arrays["a"], arrays["b"], provenance)
        except ModelError as error:
            raise ModelError(f"model file '{path}' is inconsistent: {error}") from error


def default_model_path() -> Path:
    """The paper's predictor, identified with the default seed and shipped in the package."""
    return Path(__file__).with_name("paper.npz")
