"""A CasADi least-squares problem evaluated on preallocated memory: no allocation, no copy."""

from __future__ import annotations

from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def gauss_newton(name: str, x0: Any, plan: Any, parameters: Any, residuals: Any) -> Any:
    """CasADi function (x_0, U, p) -> cost, gradient (N,), Hessian (N, N) of sum(residuals²).

    The Hessian is Gauss-Newton's, 2 J'J.
    """
    jacobian = ca.jacobian(residuals, plan)
    outputs = [
        ca.sumsqr(residuals),
        2.0 * ca.densify(jacobian.T @ residuals),
        2.0 * ca.densify(jacobian.T @ jacobian),
    ]
    return ca.Function(name, [x0, plan, parameters], outputs, {"cse": True})


class Linearisation:
    """Such a function at one state and one plan at a time."""

    def __init__(self, function: Any) -> None:
        nx, n, n_parameters = (function.size1_in(index) for index in range(3))
        self._x0, self._plan, self._parameters = np.zeros(nx), np.zeros(n), np.zeros(n_parameters)
        self._cost = np.zeros(1)
        self.gradient = np.zeros(n)  # (N,), at the last plan
        self.hessian = np.zeros((n, n))  # (N, N), at the last plan
        self._buffer, self._evaluate = function.buffer()
        for index, memory in enumerate((self._x0.data, self._plan.data, self._parameters.data)):
            self._buffer.set_arg(index, memory)
        for index, memory in enumerate((self._cost.data, self.gradient.data, self.hessian.data)):
            self._buffer.set_res(index, memory)

    def start_from(self, x0: Any, *parameters: float) -> None:
        """Set the state (nx,) to plan from and the function's parameters."""
        self._x0[:] = x0
        self._parameters[:] = parameters

    def at(self, plan: FloatArray) -> float:
        """Cost of the plan (N,); ``gradient`` and ``hessian`` follow it."""
        self._plan[:] = plan
        self._evaluate()
        return float(self._cost[0])
