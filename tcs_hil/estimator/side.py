"""One driven wheel and its motor: their state, the tyre's force and the road under it."""

from __future__ import annotations

import math

from tcs_hil.control.driveline import Driveline
from tcs_hil.control.protocol import WheelState
from tcs_hil.estimator.driveline_observer import DrivelineObserver
from tcs_hil.estimator.friction import FrictionEstimate
from tcs_hil.model.tyre import slip_ratio
from tcs_hil.model.vehicle import Vehicle

Motion = tuple[float, float]
"""Of the body: speed in m/s, and acceleration in m/s²."""


class Side:
    """What is known about one side of the car."""

    def __init__(self, driveline: Driveline, vehicle: Vehicle, period_s: float) -> None:
        self._vehicle = vehicle
        self._observer = DrivelineObserver(driveline, period_s)
        self.friction = FrictionEstimate(vehicle, period_s)
        self.force_n = 0.0

    def through_motor(
        self,
        motor_radps: float,
        motor_nm: float,
        body: Motion,
        delay_s: float,
        sent_nm: float,
    ) -> WheelState:
        """Wheel state from speed and torque of the motor, both on its side of the gear."""
        body_mps, body_mps2 = body
        gear, radius_m = self._vehicle.gear_ratio, self._vehicle.wheel_radius_m
        omega, _, twist_rad, tyre_nm = self._observer.update(gear * motor_nm, motor_radps / gear)
        self.force_n = tyre_nm / radius_m
        slip_mps = omega * radius_m - body_mps
        kappa = slip_ratio(slip_mps, omega, self._vehicle)
        self.friction.update(self.force_n, kappa)
        return WheelState(
            slip_speed_mps=slip_mps,
            wheel_speed_radps=omega,
            slip_ratio=kappa,
            vehicle_speed_mps=body_mps,
            motor_speed_radps=motor_radps,
            motor_torque_nm=motor_nm,
            shaft_twist_rad=twist_rad,
            tyre_force_n=self.force_n,
            vehicle_accel_mps2=body_mps2,
            loop_delay_s=delay_s,
            sent_nm=sent_nm,
        )

    def without_motor(
        self, omega_radps: float, body_mps: float, delay_s: float, sent_nm: float
    ) -> WheelState:
        """Wheel state from the wheel's own sensor; the motor is taken to turn with it."""
        self._observer.reset()
        self.force_n = 0.0
        slip_mps = omega_radps * self._vehicle.wheel_radius_m - body_mps
        return WheelState(
            slip_speed_mps=slip_mps,
            wheel_speed_radps=omega_radps,
            slip_ratio=slip_ratio(slip_mps, omega_radps, self._vehicle),
            vehicle_speed_mps=body_mps,
            motor_speed_radps=omega_radps * self._vehicle.gear_ratio,
            motor_torque_nm=math.nan,
            loop_delay_s=delay_s,
            sent_nm=sent_nm,
        )
