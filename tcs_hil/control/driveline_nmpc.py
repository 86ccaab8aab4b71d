"""The default nonlinear MPC: delay, driveline and an offset-free tyre force in its model."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.break_away import BreakAway
from tcs_hil.control.compensated import CompensatedController
from tcs_hil.control.driveline_core import Situation, driveline_core
from tcs_hil.control.force_disturbance import ForceDisturbance
from tcs_hil.control.integrator import BoundedIntegral
from tcs_hil.control.plan import Plan
from tcs_hil.control.protocol import WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.model.vehicle import Vehicle

FloatArray = NDArray[np.float64]

SLOWEST_MPS = 0.2

CALM_SHARE = 0.5
CALM_MPS = (4.0, 6.0)
"""Up to the first speed the slip's residuals count half, from the second on in full."""


class DrivelineOptimiser:
    """Knows the state of the driveline and the surplus force; its core predicts and plans."""

    def __init__(self, settings: ControlSettings, vehicle: Vehicle) -> None:
        self._vehicle = vehicle
        self._driveline = settings.default.driveline
        self._tuning = settings.default.nmpc
        self._period_s = settings.period_s
        self._core = driveline_core(settings, vehicle)
        self._disturbance = ForceDisturbance(settings, vehicle)

    def state(self, wheel: WheelState, integral_s: float) -> FloatArray:
        """State x (7,) at the instant ``wheel`` describes."""
        force_n = self._disturbance.update(wheel)
        gear, shaft_nm = self._vehicle.gear_ratio, force_n * self._vehicle.wheel_radius_m
        steady_twist_rad = shaft_nm / self._driveline.shaft_stiffness_nmprad
        return np.array(
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

    def advance(self, state: FloatArray, torque_nm: float, periods: float) -> FloatArray:
        """State (7,) after ``periods`` periods of a commanded motor torque."""
        duration_s = periods * self._period_s
        return self._core.after(state, torque_nm, duration_s, self._disturbance.value_n)

    def plan(self, state: FloatArray, last_torque_nm: float, torque_ref_nm: float) -> Plan:
        """Best torques (N,) in Nm within [0, torque_ref_nm]."""
        disturbance_n, urgency = self._disturbance.value_n, self._urgency(state)
        situation = Situation(torque_ref_nm, last_torque_nm, disturbance_n, urgency)
        return self._core.plan(state, situation)

    def _urgency(self, state: FloatArray) -> float:
        """Factor on the slip's residuals: 1, less at low speed, where slip is touchy."""
        slip_speed_mps, omega_radps = state[:2].tolist()
        speed_mps: float = omega_radps * self._vehicle.wheel_radius_m - slip_speed_mps
        soft = min(max(speed_mps, SLOWEST_MPS) / self._tuning.soft_speed_mps, 1.0)
        slow_mps, fast_mps = CALM_MPS
        brisk = min(max((speed_mps - slow_mps) / (fast_mps - slow_mps), 0.0), 1.0)
        return soft * (CALM_SHARE + (1.0 - CALM_SHARE) * brisk)

    def reset(self) -> None:
        """Forget the last plan and the disturbance."""
        self._core.reset()
        self._disturbance.reset()


def _or_else(value: float, steady: float) -> float:
    """What no sensor says is taken from the steady state."""
    return value if math.isfinite(value) else steady


def driveline_mpc(settings: ControlSettings, vehicle: Vehicle) -> CompensatedController:
    """One wheel's default NMPC; the first call may build CasADi's functions."""
    return CompensatedController(
        DrivelineOptimiser(settings, vehicle),
        BoundedIntegral(
            settings.slip_reference, settings.period_s, settings.default.integral_limit_s
        ),
        BreakAway(settings.slip_reference, vehicle, settings.period_s),
        settings.period_s,
        settings.default.nmpc.entry_ratio * settings.slip_reference,
    )
