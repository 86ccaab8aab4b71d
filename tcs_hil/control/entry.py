"""The slip at which a law takes over from the driver."""

from __future__ import annotations

from typing import NamedTuple

from tcs_hil.control.protocol import WheelState


class Entry(NamedTuple):
    """Least slip as a ratio and in speed; both must be passed.

    Near standstill a ratio alone is made of noise: at 0.3 m/s an error of the
    body's speed of 3 cm/s looks like the whole slip reference.
    """

    slip_ratio: float
    slip_mps: float

    def passed(self, wheel: WheelState) -> bool:
        """Whether ``wheel`` slips by more than both."""
        return wheel.slip_ratio > self.slip_ratio and wheel.slip_speed_mps > self.slip_mps
