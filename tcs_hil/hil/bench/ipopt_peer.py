"""The paper's nonlinear problem for CasADi and IPOPT: multiple shooting, run to convergence."""

from __future__ import annotations

from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.plan import Plan
from tcs_hil.control.protocol import SolveStatus, WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.control.transcription import NX, wheel_rate
from tcs_hil.model.tyre import slip_ratio
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.model.wheel import rk4

FloatArray = NDArray[np.float64]

TOLERANCE = 1e-8
QUIET: dict[str, Any] = {"ipopt.print_level": 0, "ipopt.sb": "yes", "print_time": False}
OPTIONS: dict[str, Any] = {"ipopt.tol": TOLERANCE, "ipopt.bound_relax_factor": 0.0, **QUIET}


class Ipopt:
    """An optimiser whose states and torques start from those of the tick before."""

    def __init__(self, settings: ControlSettings, vehicle: Vehicle) -> None:
        self._n = settings.nmpc.horizon
        self._solver = ca.nlpsol("peer", "ipopt", _problem(settings, vehicle), OPTIONS)
        self._guess = np.zeros((NX + 1) * self._n)

    def plan(self, wheel: WheelState, integral_s: float, torque_ref_nm: float) -> Plan:
        """Torques in Nm within [0, torque_ref_nm]."""
        n, free = self._n, np.full(NX * self._n, np.inf)
        state = (wheel.slip_speed_mps, wheel.wheel_speed_radps, integral_s)
        answer = self._solver(
            x0=self._guess,
            p=(*state, torque_ref_nm),
            lbx=np.concatenate((-free, np.zeros(n))),
            ubx=np.concatenate((free, np.full(n, torque_ref_nm))),
            lbg=0.0,
            ubg=0.0,
        )
        self._guess = np.array(answer["x"]).ravel()
        return Plan(self._guess[NX * n :], SolveStatus.OK, 0)

    def reset(self) -> None:
        """Start from nothing."""
        self._guess = np.zeros_like(self._guess)


def one_period(x: Any, torque_nm: Any, settings: ControlSettings, vehicle: Vehicle) -> Any:
    """State [s, omega, e_int] one period later, as every code here integrates it."""

    def rate(state: Any) -> Any:
        return wheel_rate(state, torque_nm, settings.slip_reference, vehicle)

    return rk4(rate, x, settings.period_s, settings.nmpc.substeps)


def slip_cost(x: Any, settings: ControlSettings, vehicle: Vehicle) -> Any:
    """Cost of one state in Nm²: Eq. (opt_NMPC_cost) over T_s w_u, without the torque's term."""
    tuning = settings.nmpc
    error = settings.slip_reference - slip_ratio(x[0], x[1], vehicle)
    cost = tuning.weight_slip * error**2 + tuning.weight_integral * x[2] ** 2
    return cost / tuning.weight_reduction


def _problem(settings: ControlSettings, vehicle: Vehicle) -> dict[str, Any]:
    n = settings.nmpc.horizon
    states, torques = ca.SX.sym("X", NX, n), ca.SX.sym("U", n)
    start, request = ca.SX.sym("x0", NX), ca.SX.sym("T_ref")
    cost, gaps, x = ca.SX(0), [], start
    for k in range(n):
        gaps.append(states[:, k] - one_period(x, torques[k], settings, vehicle))
        x = states[:, k]
        cost += slip_cost(x, settings, vehicle) + (request - torques[k]) ** 2
    return {
        "x": ca.vertcat(ca.vec(states), torques),
        "p": ca.vertcat(start, request),
        "f": cost,
        "g": ca.vertcat(*gaps),
    }
