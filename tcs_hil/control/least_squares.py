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
    outputs = gauss_newton_model(residuals, ca.jacobian(residuals, plan))
    return ca.Function(name, [x0, plan, parameters], outputs, {"cse": True})


def gauss_newton_model(residuals: Any, jacobian: Any) -> list[Any]:
    """Cost, gradient (N,) and Hessian (N, N) of the residuals with their Jacobian (n, N)."""
    return [
        ca.sumsqr(residuals),
        2.0 * ca.densify(jacobian.T @ residuals),
        2.0 * ca.densify(jacobian.T @ jacobian),
    ]


class Linearisation:
    """Such a function at one state and one plan at a time."""

    def __init__(self, function: Any) -> None:
        nx, n, n_parameters = (function.size1_in(index) for index in range(3))
        self._given = np.zeros(nx + n_parameters)  # x_0 and the parameters
        self._x0, self._parameters = self._given[:nx], self._given[nx:]
        self._cost = np.zeros(1)
        self.plan = np.zeros(n)  # (N,), the last one asked for
        self.gradient = np.zeros(n)  # (N,), there
        self.hessian = np.zeros((n, n))  # (N, N), there
        self.shrinkage = 1.0  # of the steps of `tcs_hil.control.sqp`
        self._buffer, self._evaluate = function.buffer()
        for index, memory in enumerate((self._x0.data, self.plan.data, self._parameters.data)):
            self._buffer.set_arg(index, memory)
        for index, memory in enumerate((self._cost.data, self.gradient.data, self.hessian.data)):
            self._buffer.set_res(index, memory)

    def start_from(self, x0: Any, *parameters: float) -> None:
        """Set the state (nx,) to plan from and the function's parameters."""
        self._x0[:] = x0
        self._parameters[:] = parameters

    def at(self, plan: FloatArray) -> float:
        """Cost of the plan (N,); ``gradient`` and ``hessian`` follow it."""
        self.plan[:] = plan
        self._evaluate()
        return self._cost.item()


class Tracked(Linearisation):
    """One whose gradient also follows the state and the parameters, to first order.

    Its function has a fourth output, the drift: the gradient's derivatives by
    [x_0, parameters], (N, nx + np).  What they leave out is what Gauss-Newton
    leaves out of the Hessian.
    """

    def __init__(self, function: Any) -> None:
        super().__init__(function)
        self._drift = np.zeros((self._given.size, self.plan.size))  # CasADi goes by columns
        self._buffer.set_res(3, self._drift.data)
        self.reset()

    def start_from(self, x0: Any, *parameters: float) -> None:
        """Set the state (nx,) and the parameters; ``gradient`` is the one to expect at ``plan``."""
        before = self._given.copy()
        super().start_from(x0, *parameters)
        self.gradient += (self._given - before) @ self._drift

    def reset(self) -> None:
        """Know nothing: the model of no torque at all."""
        for memory in (self.plan, self.gradient, self._drift):
            memory.fill(0.0)
        self.shrinkage = 1.0
        self.hessian[:] = np.eye(self.plan.size)
