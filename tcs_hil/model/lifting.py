"""From the wheel's state to the lifted state: scaling and dictionary of observables."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import msgspec
import numpy as np
from numpy.typing import NDArray

from tcs_hil.errors import ModelError
from tcs_hil.model.vehicle import Positive, Vehicle
from tcs_hil.model.wheel import slip_ratio

FloatArray = NDArray[np.float64]

SLIP_SPEED, WHEEL_SPEED, SLIP_RATIO = 0, 1, 2
"""Where every dictionary puts scaled s, scaled omega and kappa in the lifted state."""


MAX_ORDER = 8
"""Of the monomials; beyond it the regression is numerically meaningless."""


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


class Dictionary(Protocol):
    """Observables of one state: the lifted state begins with [s, omega, kappa]."""

    @property
    def name(self) -> str:
        """Key in ``DICTIONARIES``."""
        ...

    @property
    def order(self) -> int:
        """Richness of the dictionary, in its own terms."""
        ...

    @property
    def size(self) -> int:
        """Length nz of the lifted state."""
        ...

    def observables(self, s: Any, omega: Any, kappa: Any) -> list[Any]:
        """The nz observables of scaled s and omega, as floats or columns (n,)."""
        ...


@dataclass(frozen=True, slots=True)
class Monomials:
    """Monomials of scaled s and omega up to ``order``, and kappa: Eqs. (basis_poly), (lift).

    z = [s, omega, kappa, s², s omega, omega², s³, ..., omega^order, 1].  First-order
    monomials are the state itself and appear once; the constant stays, because
    the predictor is affine in physical units and much worse without it.
    """

    order: int = 4

    def __post_init__(self) -> None:
        if not 1 <= self.order <= MAX_ORDER:
            raise ModelError(f"order of the monomials must be 1 to {MAX_ORDER}, not {self.order}")

    @property
    def name(self) -> str:
        """Key in ``DICTIONARIES``."""
        return "monomials"

    @property
    def size(self) -> int:
        """Monomials in two variables up to the order, the constant included, and kappa."""
        return (self.order + 1) * (self.order + 2) // 2 + 1

    def observables(self, s: Any, omega: Any, kappa: Any) -> list[Any]:
        """The nz observables; each order costs one multiplication per monomial."""
        values = [s, omega, kappa]
        degree = [s, omega]
        for _ in range(self.order - 1):
            degree = [s * monomial for monomial in degree] + [omega * degree[-1]]
            values += degree
        values.append(s * 0.0 + 1.0)  # of the same shape as s
        return values


DICTIONARIES: dict[str, Callable[[int], Dictionary]] = {"monomials": Monomials}


def make_dictionary(name: str, order: int) -> Dictionary:
    """Dictionary chosen by name.  Raises ModelError for a name nobody knows."""
    if name not in DICTIONARIES:
        raise ModelError(f"dictionary '{name}' is unknown; known are {', '.join(DICTIONARIES)}")
    return DICTIONARIES[name](order)


@dataclass(frozen=True, slots=True)
class Lifting:
    """The map from one wheel's state in physical units to the lifted state."""

    dictionary: Dictionary
    scaling: Scaling
    vehicle: Vehicle

    def lift(self, s_mps: Any, omega_radps: Any) -> FloatArray:
        """Lifted state (nz,) of one state given as floats, or (n, nz) of columns (n,)."""
        s = self.scaling.scale_s(s_mps)
        omega = self.scaling.scale_omega(omega_radps)
        kappa = slip_ratio(s_mps, omega_radps, self.vehicle)
        return np.array(self.dictionary.observables(s, omega, kappa)).T
