"""The nonlinear MPC: the paper's optimal control problem solved to convergence every tick."""

from __future__ import annotations

from tcs_hil.control.integrator import SlipErrorIntegral
from tcs_hil.control.least_squares import Tracked
from tcs_hil.control.plan import Plan
from tcs_hil.control.predictive import PredictiveController
from tcs_hil.control.protocol import WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.control.sqp import expected, minimise
from tcs_hil.control.transcription import gauss_newton_function
from tcs_hil.model.vehicle import Vehicle


class NonlinearOptimiser:
    """Eq. (opt_NMPC) by Gauss-Newton SQP, warm from the last tick's quadratic model.

    The model is moved to the new state and solved for the guess.  The wheel speed
    comes in steps of the bus's resolution, so the first torque jumps by Newton
    metres from tick to tick; this guess jumps with it and leaves about 1e-3 Nm to
    the one linearisation that a tick needs as a rule.
    """

    def __init__(self, settings: ControlSettings, vehicle: Vehicle) -> None:
        self._problem = Tracked(gauss_newton_function(settings, vehicle))
        self._patience = settings.nmpc

    def plan(self, wheel: WheelState, integral_s: float, torque_ref_nm: float) -> Plan:
        """Best torques (N,) in Nm within [0, torque_ref_nm]."""
        state = (wheel.slip_speed_mps, wheel.wheel_speed_radps, integral_s)
        self._problem.start_from(state, torque_ref_nm)
        guess = expected(self._problem, torque_ref_nm)
        return minimise(self._problem, guess, torque_ref_nm, self._patience)

    def reset(self) -> None:
        """Forget the last model."""
        self._problem.reset()


def nonlinear_mpc(settings: ControlSettings, vehicle: Vehicle) -> PredictiveController:
    """One wheel's NMPC; the first call builds CasADi's function."""
    return PredictiveController(
        NonlinearOptimiser(settings, vehicle),
        SlipErrorIntegral(settings.slip_reference, settings.period_s),
    )
