"""The paper's slip and tyre, written once for floats, arrays and CasADi symbols.

``s`` is the slip speed omega R - v in m/s and ``omega`` the wheel speed in
rad/s.  Sine, arctangent and root come from the ``functions`` argument, so that
the estimator (``math``), the data set (``numpy``) and the nonlinear MPC
(``casadi``) share these equations instead of copying them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol, TypeAlias

import numpy as np

AnyVehicle: TypeAlias = Any
"""A ``Vehicle``, or CasADi's symbols under the same names, which are not numbers: mypyc must not
make any of them."""


class Functions(Protocol):
    """What the tyre needs from ``math``, ``numpy`` or ``casadi``."""

    @property
    def sin(self) -> Callable[[Any], Any]:
        """Sine of an angle in rad."""
        ...

    @property
    def atan(self) -> Callable[[Any], Any]:
        """Arctangent, in rad."""
        ...

    @property
    def sqrt(self) -> Callable[[Any], Any]:
        """Square root."""
        ...


def slip_ratio(s: Any, omega: Any, vehicle: AnyVehicle) -> Any:
    """Modified slip ratio kappa of Eq. (slip_mod); finite at standstill."""
    rim_speed = omega * vehicle.wheel_radius_m
    return s * rim_speed / (rim_speed * rim_speed + vehicle.slip_epsilon_m2ps2)


class Tyre:
    """One vehicle's simplified Magic Formula, Eq. (tire_model), its parameters read once."""

    def __init__(self, vehicle: AnyVehicle, functions: Functions = np) -> None:
        self._peak_n: Any = vehicle.friction_ratio * vehicle.wheel_load_n * vehicle.tyre_d
        self._c: Any = vehicle.tyre_c
        self._b: Any = vehicle.tyre_b
        self._sin, self._atan, self._sqrt = functions.sin, functions.atan, functions.sqrt

    def force_n(self, kappa: Any) -> Any:
        """Longitudinal tyre force in N."""
        return self._peak_n * self._sin(self._c * self._atan(self._b * kappa))

    def secant_ratio(self, kappa: Any) -> Any:
        """Force over what the curve's slope at the origin would give, in (0, 1], within 0.04.

        Without the sine's 0 / 0 at the origin; the factor is fitted for the paper's tyre.
        """
        bend = 1.3 * self._b * kappa
        return 1.0 / self._sqrt(1.0 + bend * bend)


def tyre_force_n(kappa: Any, vehicle: AnyVehicle, functions: Functions = np) -> Any:
    """Longitudinal tyre force in N of a tyre that is asked once."""
    return Tyre(vehicle, functions).force_n(kappa)
