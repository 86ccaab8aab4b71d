"""What every estimator hands to the control laws."""

from __future__ import annotations

from typing import Protocol

import msgspec

from tcs_hil.control.protocol import WheelState
from tcs_hil.signals import UNKNOWN_ROAD, Measurement, Pair, RoadEstimate


class Estimate(msgspec.Struct, frozen=True):
    """State of the car at one tick: body speed and both driven wheels (left, right)."""

    vehicle_speed_mps: float
    wheels: tuple[WheelState, WheelState]
    road: RoadEstimate = UNKNOWN_ROAD


class Estimates(Protocol):
    """Infers what no sensor on the bus says."""

    @property
    def newest(self) -> Estimate:
        """The estimate of the last tick."""
        ...

    def update(self, measurement: Measurement) -> Estimate:
        """Estimate from the newest measurement; called once a tick."""
        ...

    def sent(self, torque_nm: Pair, request_nm: Pair) -> None:
        """Hear, at the tick's end, what each motor may give of what the driver asks of it."""
        ...
