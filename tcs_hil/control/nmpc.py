"""The nonlinear MPC: the paper's optimal control problem solved to convergence every tick."""

from __future__ import annotations

import numpy as np

from tcs_hil.control.integrator import SlipErrorIntegral
from tcs_hil.control.least_squares import Linearisation
from tcs_hil.control.plan import Plan
from tcs_hil.control.predictive import PredictiveController
from tcs_hil.control.protocol import WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.control.sqp import minimise
from tcs_hil.control.transcription import gauss_newton_function
from tcs_hil.model.vehicle import Vehicle


class NonlinearOptimiser:
    """Eq. (opt_NMPC) by Gauss-Newton SQP, warm from the last two plans.

    The plan goes on changing as it did, each element by itself.  It is not
    shifted: between two ticks the optimum moves far less than its own elements
    differ from one another.  Along the paper's manoeuvres 97 % of these guesses
    need one linearisation only; the last plan alone needs two as a rule.
    """

    def __init__(self, settings: ControlSettings, vehicle: Vehicle) -> None:
        self._problem = Linearisation(gauss_newton_function(settings, vehicle))
        self._max_iterations = settings.nmpc.max_iterations
        self._last = self._before = np.zeros(settings.nmpc.horizon)  # plans (N,) in Nm

    def plan(self, wheel: WheelState, integral_s: float, torque_ref_nm: float) -> Plan:
        """Best torques (N,) in Nm within [0, torque_ref_nm]."""
        state = (wheel.slip_speed_mps, wheel.wheel_speed_radps, integral_s)
        self._problem.start_from(state, torque_ref_nm)
        guess = (2.0 * self._last - self._before).clip(0.0, torque_ref_nm)
        plan = minimise(self._problem, guess, torque_ref_nm, self._max_iterations)
        self._before, self._last = self._last, plan.inputs
        return plan

    def reset(self) -> None:
        """Forget the last plans."""
        self._last = self._before = np.zeros_like(self._last)


def nonlinear_mpc(settings: ControlSettings, vehicle: Vehicle) -> PredictiveController:
    """One wheel's NMPC; the first call builds CasADi's function."""
    return PredictiveController(
        NonlinearOptimiser(settings, vehicle),
        SlipErrorIntegral(settings.slip_reference, settings.period_s),
    )
