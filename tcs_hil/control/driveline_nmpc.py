"""The default nonlinear MPC: delay, driveline and an offset-free tyre force in its model."""

from __future__ import annotations

import math
from collections.abc import Sequence

from tcs_hil.control.body_disturbance import BodyDisturbance
from tcs_hil.control.compensated import CompensatedController
from tcs_hil.control.driveline_core import Disturbance, FloatArray, driveline_core
from tcs_hil.control.entry import Entry
from tcs_hil.control.force_disturbance import ForceDisturbance
from tcs_hil.control.guarded import GuardedController
from tcs_hil.control.integrator import BoundedIntegral
from tcs_hil.control.pi import PiController
from tcs_hil.control.plan import Plan
from tcs_hil.control.protocol import Controller, WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.control.swing_guard import SwingGuard
from tcs_hil.model.vehicle import Vehicle

SLOWEST_MPS = 0.2
ANY_SPEED_MPS = (-math.inf, math.inf)

STAB_RINGS_S = 0.1
"""The wheel swings so long after a stab at the pedal without the law's doing.  The default KMPC
needs no such time: its ceiling after a break-away answers the stab."""

CALM_SHARE = 0.5
CALM_MPS = (4.0, 6.0)
"""Up to the first speed the slip's residuals count half, from the second on in full."""


class DrivelineOptimiser:
    """Knows the state of the driveline and what disturbs it; its core predicts and plans."""

    def __init__(self, settings: ControlSettings, vehicle: Vehicle) -> None:
        self._vehicle = vehicle
        self._driveline = settings.default.driveline
        self._tuning = settings.default.nmpc
        self._core = driveline_core(settings, vehicle)
        self._force = ForceDisturbance(settings, vehicle, self._tuning.observer_time_s)
        self._body = BodyDisturbance(vehicle, settings.period_s)

    @property
    def state(self) -> FloatArray:
        """State x (7,) as the last call has left it; valid until the next."""
        return self._core.x

    def observe(self, wheel: WheelState, integral_s: float) -> None:
        """The state is the one at the instant ``wheel`` describes; learns what disturbs it."""
        self._body.learn(wheel)
        force_n = self._force.update(wheel)
        gear, shaft_nm = self._vehicle.gear_ratio, force_n * self._vehicle.wheel_radius_m
        steady_twist_rad = shaft_nm / self._driveline.shaft_stiffness_nmprad
        self._core.start_from(
            (
                wheel.slip_speed_mps,
                wheel.wheel_speed_radps,
                integral_s,
                _or_else(wheel.motor_torque_nm, shaft_nm / gear),
                wheel.motor_speed_radps / gear,
                _or_else(wheel.shaft_twist_rad, steady_twist_rad),
                force_n,
            )
        )

    def roll_forward(self, torques_nm: Sequence[float], first_periods: float) -> None:
        """Carry the state through torques, the first for a part of a period, then one each."""
        self._core.roll_forward(torques_nm, first_periods, self._disturbance())

    def plan(self, last_torque_nm: float, torque_ref_nm: float) -> Plan:
        """Best torques (N,) in Nm within [0, torque_ref_nm]."""
        return self._core.plan(last_torque_nm, torque_ref_nm, self._disturbance(), self._urgency())

    def _disturbance(self) -> Disturbance:
        return self._force.value_n, self._body.value_mps2

    def _urgency(self) -> float:
        """Factor on the slip's residuals: 1, less at low speed, where slip is touchy."""
        slip_speed_mps, omega_radps = self._core.x.item(0), self._core.x.item(1)
        speed_mps: float = omega_radps * self._vehicle.wheel_radius_m - slip_speed_mps
        soft = min(max(speed_mps, SLOWEST_MPS) / self._tuning.soft_speed_mps, 1.0)
        slow_mps, fast_mps = CALM_MPS
        brisk = min(max((speed_mps - slow_mps) / (fast_mps - slow_mps), 0.0), 1.0)
        return soft * (CALM_SHARE + (1.0 - CALM_SHARE) * brisk)

    def reset(self) -> None:
        """Forget the last plan and what disturbs."""
        self._core.reset()
        self._force.reset()
        self._body.reset()


def _or_else(value: float, steady: float) -> float:
    """What no sensor says is taken from the steady state."""
    return value if -math.inf < value < math.inf else steady


def driveline_mpc(settings: ControlSettings, vehicle: Vehicle) -> Controller:
    """One wheel's default NMPC, the PI where no motor shows; may build CasADi's functions."""
    tuning = settings.default.nmpc
    law = CompensatedController(
        DrivelineOptimiser(settings, vehicle),
        BoundedIntegral(
            settings.slip_reference, settings.period_s, settings.default.integral_limit_s
        ),
        SwingGuard(settings.slip_reference, vehicle, settings.period_s, STAB_RINGS_S),
        settings.period_s,
        entry=Entry(tuning.entry_ratio * settings.slip_reference, tuning.entry_slip_mps),
    )
    return GuardedController(law, PiController(settings), ANY_SPEED_MPS, settings.period_s)
