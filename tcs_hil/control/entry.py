"""The slip at which a law takes over from the driver."""

from __future__ import annotations

from tcs_hil.control.protocol import WheelState


class Entry:
    """Least slip as a ratio and in speed; both must be passed.

    Near standstill a ratio alone is made of noise: at 0.3 m/s an error of the
    body's speed of 3 cm/s looks like the whole slip reference.
    """

    def __init__(self, slip_ratio: float, slip_mps: float) -> None:
        self._slip_ratio = slip_ratio
        self._slip_mps = slip_mps

    def passed(self, wheel: WheelState) -> bool:
        """Whether ``wheel`` slips by more than both."""
        return wheel.slip_ratio > self._slip_ratio and wheel.slip_speed_mps > self._slip_mps
