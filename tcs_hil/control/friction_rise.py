"""Whether the road has just begun to carry more than the tyre was held at."""

from __future__ import annotations

import math

from tcs_hil.control.protocol import WheelState

HELD_SHARE = 0.5
HELD_S = 0.3
"""A wheel held above this share of the slip reference for so long shows what the road carries."""
RISE_SHARE = 1.3
KICK_S = 0.25
"""So much more force, within this time of being held, comes from another road."""
SLOWEST_MPS = 3.0
"""Below it slip answers torque so fast that the loop keeps up whatever the road began."""


class FrictionRise:
    """Tells the kick of a better road from a swing that the loop has begun.

    Where friction rises the tyre grips with the slip of the road before, pushes
    several times as much at once and stops the wheel, which then swings by itself.
    In a launch force rises too, but on a wheel that was not held at its reference
    before; and a swing leaves the reference twice in every period.
    """

    def __init__(self, slip_reference: float, period_s: float) -> None:
        self._held_ratio = HELD_SHARE * slip_reference
        self._period_s = period_s
        self._held_s = 0.0
        self._since_s = math.inf  # since the wheel was last held

    def shows(self, wheel: WheelState, carried_n: float) -> bool:
        """Whether this tick's force is beyond what the tyre carried; called once a tick."""
        held = wheel.slip_ratio > self._held_ratio
        self._held_s = self._held_s + self._period_s if held else 0.0
        self._since_s = 0.0 if self._held_s > HELD_S else self._since_s + self._period_s
        if held or wheel.vehicle_speed_mps < SLOWEST_MPS or self._since_s > KICK_S:
            return False
        return wheel.tyre_force_n > RISE_SHARE * carried_n

    def reset(self) -> None:
        """Nothing was held."""
        self._held_s, self._since_s = 0.0, math.inf
