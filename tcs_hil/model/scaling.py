"""Bringing slip speed, wheel speed and torque to zero mean and unit standard deviation."""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from tcs_hil.errors import ModelError
from tcs_hil.model.vehicle import Positive

FloatArray = NDArray[np.float64]


class Scaling(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Means and standard deviations that bring s, omega and the torque to unit size.

    One scaling serves x and its successor alike.  The slip ratio is not scaled:
    the weights of the paper's controller hold in exactly these coordinates.
    """

    s_mean_mps: float
    s_std_mps: Positive
    omega_mean_radps: float
    omega_std_radps: Positive
    torque_mean_nm: float
    torque_std_nm: Positive

    def scale_s(self, s_mps: Any) -> Any:
        """Slip speed in standard deviations from its mean."""
        return (s_mps - self.s_mean_mps) / self.s_std_mps

    def scale_omega(self, omega_radps: Any) -> Any:
        """Wheel speed in standard deviations from its mean."""
        return (omega_radps - self.omega_mean_radps) / self.omega_std_radps

    def scale_torque(self, torque_nm: Any) -> Any:
        """Motor torque in standard deviations from its mean."""
        return (torque_nm - self.torque_mean_nm) / self.torque_std_nm

    def unscale_s(self, scaled: Any) -> Any:
        """Slip speed in m/s."""
        return scaled * self.s_std_mps + self.s_mean_mps

    def unscale_omega(self, scaled: Any) -> Any:
        """Wheel speed in rad/s."""
        return scaled * self.omega_std_radps + self.omega_mean_radps


def fit_scaling(x: FloatArray, u: FloatArray, x_next: FloatArray) -> Scaling:
    """Scaling of a data set: x, x_next (n, 2) taken together, torque u (n, 1).

    Raises ModelError for a quantity that never changes.
    """
    states = np.concatenate((x, x_next))
    (s_mean, omega_mean), (s_std, omega_std) = states.mean(axis=0), states.std(axis=0)
    if min(s_std, omega_std, u.std()) == 0.0:
        raise ModelError("slip speed, wheel speed or torque never changes in the data set")
    return Scaling(
        s_mean_mps=float(s_mean),
        s_std_mps=float(s_std),
        omega_mean_radps=float(omega_mean),
        omega_std_radps=float(omega_std),
        torque_mean_nm=float(u.mean()),
        torque_std_nm=float(u.std()),
    )
