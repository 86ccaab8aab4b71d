"""An optimiser that remembers what it was asked and what it answered."""

from __future__ import annotations

from dataclasses import dataclass, field

from tcs_hil.control.plan import Plan
from tcs_hil.control.predictive import Optimiser
from tcs_hil.control.protocol import WheelState
from tests.control.quarter_car import GEAR, RADIUS_M, slip


@dataclass(frozen=True)
class Call:
    """One optimisation: the question and the answer."""

    wheel: WheelState
    integral_s: float
    torque_ref_nm: float
    plan: Plan


@dataclass
class Recorder:
    """Passes every call on to the law under test."""

    optimiser: Optimiser
    calls: list[Call] = field(default_factory=list)

    def plan(self, wheel: WheelState, integral_s: float, torque_ref_nm: float) -> Plan:
        plan = self.optimiser.plan(wheel, integral_s, torque_ref_nm)
        kept = Plan(plan.inputs.copy(), plan.status, plan.iterations)
        self.calls.append(Call(wheel, integral_s, torque_ref_nm, kept))
        return plan

    def reset(self) -> None:
        self.optimiser.reset()


def wheel_at(speed_mps: float, kappa: float, torque_nm: float = 0.0) -> WheelState:
    """A wheel at a vehicle speed and a plain slip ratio (omega R - v) / (omega R)."""
    omega = speed_mps / (1.0 - kappa) / RADIUS_M
    return WheelState(
        slip_speed_mps=omega * RADIUS_M - speed_mps,
        wheel_speed_radps=omega,
        slip_ratio=slip(speed_mps, omega),
        vehicle_speed_mps=speed_mps,
        motor_speed_radps=omega * GEAR,
        motor_torque_nm=torque_nm,
    )
