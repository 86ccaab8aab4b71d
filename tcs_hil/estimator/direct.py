"""Speeds as they are on the bus: body from the rolling rear wheels, slip of each front wheel."""

from __future__ import annotations

from tcs_hil.control.protocol import WheelState
from tcs_hil.estimator.estimate import Estimate
from tcs_hil.estimator.held import held
from tcs_hil.model.tyre import slip_ratio
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.signals import FourWheels, Measurement, Pair


class Estimator:
    """Infers what no sensor on the bus says.

    A wheel whose validity flag is down keeps its last good speed here; whether
    that may still be acted on is for the supervisor to decide.
    """

    def __init__(self, vehicle: Vehicle) -> None:
        self._vehicle = vehicle
        self._wheel_speed_radps: FourWheels = (0.0, 0.0, 0.0, 0.0)
        self.newest = Estimate(0.0, (WheelState.at_rest(), WheelState.at_rest()))

    def update(self, measurement: Measurement) -> Estimate:
        """Estimate speed and slip from the newest measurement."""
        self._wheel_speed_radps = held(measurement, self._wheel_speed_radps)
        fl, fr, _, _ = self._wheel_speed_radps
        speed_mps = self._body_speed_mps(measurement)
        self.newest = Estimate(
            speed_mps,
            (
                self._wheel(fl, speed_mps, measurement, 0),
                self._wheel(fr, speed_mps, measurement, 1),
            ),
        )
        return self.newest

    def sent(self, torque_nm: Pair, request_nm: Pair) -> None:
        """Nothing to learn: the paper knows no delay."""

    def _body_speed_mps(self, measurement: Measurement) -> float:
        """Mean of the rear wheels that vouch for themselves; both held when neither does."""
        _, _, left_radps, right_radps = self._wheel_speed_radps
        _, _, left_valid, right_valid = measurement.wheel_speed_valid
        if left_valid == right_valid:
            mean_radps = (left_radps + right_radps) / 2.0
        else:
            mean_radps = left_radps if left_valid else right_radps
        return mean_radps * self._vehicle.wheel_radius_m

    def _wheel(
        self, speed_radps: float, body_mps: float, measurement: Measurement, side: int
    ) -> WheelState:
        slip_speed_mps = speed_radps * self._vehicle.wheel_radius_m - body_mps
        return WheelState(
            slip_speed_mps=slip_speed_mps,
            wheel_speed_radps=speed_radps,
            slip_ratio=float(slip_ratio(slip_speed_mps, speed_radps, self._vehicle)),
            vehicle_speed_mps=body_mps,
            motor_speed_radps=measurement.motor_speed_radps[side],
            motor_torque_nm=measurement.motor_torque_nm[side],
        )
