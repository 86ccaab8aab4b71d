"""Radial dictionaries: thin-plate splines and Gaussians around centres drawn from the data."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tcs_hil.errors import ModelError

FloatArray = NDArray[np.float64]
Centres = tuple[tuple[float, float], ...]
"""Scaled s and omega of each centre."""

Kernel = Callable[[Any], Any]
"""From the squared distance to the centre to the observable."""

NEARLY_ZERO = 1e-12
"""Keeps the logarithm finite at a centre, where the thin plate is 0 anyway."""


def thin_plate(squared: Any) -> Any:
    """r² log r."""
    return 0.5 * squared * np.log(squared + NEARLY_ZERO)


def gaussian(squared: Any) -> Any:
    """exp(-r²/2): one standard deviation of the data wide."""
    return np.exp(-0.5 * squared)


KERNELS: dict[str, Kernel] = {"thin-plate": thin_plate, "gaussian": gaussian}


@dataclass(frozen=True, slots=True)
class RadialBasis:
    """z = [s, omega, kappa, one kernel per centre, 1]."""

    kernel: Kernel
    centres: Centres

    @property
    def size(self) -> int:
        """State, slip ratio, centres and the constant."""
        return len(self.centres) + 4

    def observables(self, s: Any, omega: Any, kappa: Any) -> list[Any]:
        """The nz observables of scaled s and omega, as floats or columns (n,)."""
        bumps = [self.kernel((s - x) ** 2 + (omega - y) ** 2) for x, y in self.centres]
        return [s, omega, kappa, *bumps, s * 0.0 + 1.0]


def centre_count(order: int) -> int:
    """As many centres as monomials of degree 2 to ``order``: equal sizes make a fair comparison."""
    return (order + 1) * (order + 2) // 2 - 3


def draw_centres(states: FloatArray, count: int, seed: int) -> Centres:
    """Some of the scaled states (n, 2), each at most once.  Raises ModelError for too few."""
    if count > len(states):
        raise ModelError(f"{count} centres cannot be drawn from {len(states)} states")
    rows = np.random.default_rng(seed).choice(len(states), count, replace=False)
    return tuple((float(s), float(omega)) for s, omega in states[rows])
