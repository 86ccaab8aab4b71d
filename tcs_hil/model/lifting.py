"""From the wheel's state to the lifted state, by a dictionary of observables chosen by name."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from tcs_hil.errors import ModelError
from tcs_hil.model.radial import KERNELS, Centres, RadialBasis, centre_count
from tcs_hil.model.scaling import Scaling
from tcs_hil.model.tyre import slip_ratio
from tcs_hil.model.vehicle import Vehicle

FloatArray = NDArray[np.float64]

SLIP_RATIO = 2
"""Where every dictionary puts kappa in the lifted state, after scaled s and scaled omega."""

MAX_ORDER = 8
"""Of the monomials; beyond it the regression is numerically meaningless."""


class Dictionary(Protocol):
    """Observables of one state: the lifted state begins with [s, omega, kappa]."""

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


DICTIONARIES = ("monomials", *KERNELS)


def make_dictionary(name: str, order: int, centres: Centres = ()) -> Dictionary:
    """Dictionary chosen by name; the radial ones stand on ``centres``.

    Raises ModelError for a name nobody knows, an order out of bounds, or centres
    that do not fit the order.
    """
    if name not in DICTIONARIES:
        raise ModelError(f"dictionary '{name}' is unknown; known are {', '.join(DICTIONARIES)}")
    if name == "monomials":
        return Monomials(order)
    if not 2 <= order <= MAX_ORDER or len(centres) != centre_count(order):
        raise ModelError(f"{len(centres)} centres do not fit dictionary '{name}' of order {order}")
    return RadialBasis(KERNELS[name], centres)


@dataclass(frozen=True, slots=True)
class Lifting:
    """The map from one wheel's state in physical units to the lifted state."""

    dictionary: Dictionary
    scaling: Scaling
    vehicle: Vehicle

    def lift(self, s_mps: Any, omega_radps: Any) -> FloatArray:
        """Lifted state (nz,) of one state given as floats, or (n, nz) of columns (n,)."""
        return np.array(self.observables(s_mps, omega_radps)).T

    def observables(self, s_mps: Any, omega_radps: Any) -> list[Any]:
        """The nz elements of the lifted state, as floats or columns (n,)."""
        s = self.scaling.scale_s(s_mps)
        omega = self.scaling.scale_omega(omega_radps)
        kappa = slip_ratio(s_mps, omega_radps, self.vehicle)
        return self.dictionary.observables(s, omega, kappa)
