"""The default estimator: every sensor of the bus where it is best."""

from __future__ import annotations

import math
from typing import Final

from tcs_hil.control.protocol import WheelState
from tcs_hil.control.settings import ControlSettings
from tcs_hil.estimator.body_speed import BodySpeed
from tcs_hil.estimator.edge_age import EdgeAge
from tcs_hil.estimator.estimate import Estimate
from tcs_hil.estimator.held import held
from tcs_hil.estimator.loop_delay import LoopDelay
from tcs_hil.estimator.side import Side
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.signals import FourWheels, Measurement, Pair, RoadEstimate

MOTOR_PATIENCE_S: Final = 0.005
"""A motor state older than two cycles is no measurement; the wheel's own sensor serves."""


class FusedEstimator:
    """Body speed from rear wheels and accelerometer, front wheels through their motors.

    As in the plain estimator, a wheel whose validity flag is down keeps its last
    good speed.  Without an accelerometer the tyres' forces stand in for it.
    """

    def __init__(self, settings: ControlSettings, vehicle: Vehicle) -> None:
        self._vehicle = vehicle
        driveline = settings.default.driveline
        self._body = BodySpeed(settings.period_s)
        self._left, self._right = (Side(driveline, vehicle, settings.period_s) for _ in range(2))
        self._ages = tuple(EdgeAge(settings.period_s) for _ in range(2))
        self._delay = LoopDelay(settings.default.delay, driveline.motor_lag_s, settings.period_s)
        self._wheel_speed_radps: FourWheels = (0.0, 0.0, 0.0, 0.0)
        self._sent_nm: Pair = (math.nan, math.nan)
        self.newest = Estimate(0.0, (WheelState.at_rest(), WheelState.at_rest()))

    def update(self, measurement: Measurement) -> Estimate:
        """Estimate speeds, slip, shaft twist, tyre force, friction and delay."""
        self._wheel_speed_radps = held(measurement, self._wheel_speed_radps)
        delay_s = self._delay.heard(measurement.motor_torque_nm)
        speed_mps = self._body_speed_mps(measurement)
        wheels = (
            self._wheel(self._left, 0, measurement, speed_mps, delay_s),
            self._wheel(self._right, 1, measurement, speed_mps, delay_s),
        )
        left, right = self._left.friction, self._right.friction
        road = RoadEstimate(
            friction_ratio=(left.value_ratio, right.value_ratio),
            confidence_ratio=(left.confidence_ratio, right.confidence_ratio),
            loop_delay_s=delay_s,
        )
        self.newest = Estimate(speed_mps, wheels, road)
        return self.newest

    def sent(self, torque_nm: Pair, request_nm: Pair) -> None:
        """Hear, at the tick's end, what each motor may give of what the driver asks of it."""
        self._delay.sent(torque_nm, request_nm)
        self._sent_nm = torque_nm

    def _body_speed_mps(self, m: Measurement) -> float:
        accel_mps2 = m.accel_x_mps2
        if not math.isfinite(accel_mps2):
            accel_mps2 = (self._left.force_n + self._right.force_n) / self._vehicle.mass_kg
        radius_m = self._vehicle.wheel_radius_m
        _, _, left_radps, right_radps = self._wheel_speed_radps
        rear_mps = (left_radps * radius_m, right_radps * radius_m)
        front_left_radps, front_right_radps = self._driven_radps(m)
        driven_mps = max(abs(front_left_radps), abs(front_right_radps)) * radius_m
        _, _, left_valid, right_valid = m.wheel_speed_valid
        trusted = (left_valid, right_valid)
        return self._body.update(rear_mps, trusted, accel_mps2, driven_mps)

    def _driven_radps(self, m: Measurement) -> Pair:
        """The front wheels through their motors, which show the first turn, or by their sensors."""
        if m.motor_age_s > MOTOR_PATIENCE_S:
            return self._wheel_speed_radps[:2]
        left, right = m.motor_speed_radps
        return left / self._vehicle.gear_ratio, right / self._vehicle.gear_ratio

    def _wheel(
        self, side: Side, index: int, m: Measurement, body_mps: float, delay_s: float
    ) -> WheelState:
        accel_mps2, shown_radps = self._body.accel_mps2, self._wheel_speed_radps[index]
        age_s = self._ages[index].update(shown_radps)
        if m.motor_age_s > MOTOR_PATIENCE_S:
            gained_radps = age_s * accel_mps2 / self._vehicle.wheel_radius_m
            omega_radps = max(shown_radps + gained_radps, 0.0)
            return side.without_motor(omega_radps, body_mps, delay_s, self._sent_nm[index])
        motor_radps, motor_nm = m.motor_speed_radps[index], m.motor_torque_nm[index]
        motion = body_mps, accel_mps2
        return side.through_motor(motor_radps, motor_nm, motion, delay_s, self._sent_nm[index])
