"""The paper's nonlinear problem in do-mpc, as its documentation sets a controller up."""

from __future__ import annotations

from typing import Any

import do_mpc
import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.plan import Plan
from tcs_hil.control.protocol import SolveStatus, WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.control.transcription import NX
from tcs_hil.hil.bench.ipopt_peer import OPTIONS, one_period, slip_cost
from tcs_hil.model.vehicle import Vehicle

FloatArray = NDArray[np.float64]


class DoMpc:
    """do-mpc with the same model and integrator as everybody, and IPOPT as it comes."""

    def __init__(self, settings: ControlSettings, vehicle: Vehicle) -> None:
        self._mpc, self._request = _controller(settings, vehicle)
        self._fresh = True

    def plan(self, wheel: WheelState, integral_s: float, torque_ref_nm: float) -> Plan:
        """Torques in Nm within [0, torque_ref_nm]; only the first is handed out."""
        state = np.array((wheel.slip_speed_mps, wheel.wheel_speed_radps, integral_s))
        self._request["_tvp", :] = torque_ref_nm
        self._mpc.ub_opt_x["_u"] = torque_ref_nm
        if self._fresh:
            self._mpc.x0 = state
            self._mpc.set_initial_guess()
            self._fresh = False
        torque_nm = self._mpc.make_step(state).ravel()
        return Plan(torque_nm, SolveStatus.OK, 0)

    def reset(self) -> None:
        """Start from nothing."""
        self._fresh = True


def _controller(settings: ControlSettings, vehicle: Vehicle) -> tuple[Any, Any]:
    model = _model(settings, vehicle)
    mpc = do_mpc.controller.MPC(model)
    mpc.settings.n_horizon = settings.nmpc.horizon
    mpc.settings.t_step = settings.period_s
    mpc.settings.n_robust = 0
    mpc.settings.store_full_solution = False
    mpc.settings.nlpsol_opts = OPTIONS
    # The state before the first period is given: its share of the sum moves no minimum.
    x, torque, request = model.x["x"], model.u["torque"], model.tvp["request"]
    cost = slip_cost(x, settings, vehicle)
    mpc.set_objective(mterm=cost, lterm=cost + (request - torque) ** 2)
    mpc.set_rterm(torque=0.0)
    mpc.bounds["lower", "_u", "torque"] = 0.0
    mpc.bounds["upper", "_u", "torque"] = vehicle.motor_torque_max_nm
    template = mpc.get_tvp_template()
    mpc.set_tvp_fun(lambda _now_s: template)
    mpc.setup()
    return mpc, template


def _model(settings: ControlSettings, vehicle: Vehicle) -> Any:
    model = do_mpc.model.Model("discrete", "SX")
    x = model.set_variable("_x", "x", shape=(NX, 1))
    torque = model.set_variable("_u", "torque")
    model.set_variable("_tvp", "request")
    model.set_rhs("x", one_period(x, torque, settings, vehicle))
    model.setup()
    return model
