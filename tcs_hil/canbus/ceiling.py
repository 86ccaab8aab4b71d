"""A torque ceiling on the bus: one raw value is kept for "no limit"."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tcs_hil.canbus.codec import SignalSpec
from tcs_hil.canbus.contract import NO_LIMIT_LABEL, NO_LIMIT_SIGNALS
from tcs_hil.canbus.database import MessageSpec
from tcs_hil.signals import NO_LIMIT


@dataclass(frozen=True, slots=True)
class CeilingCode:
    """Physical values of one ceiling signal: the largest real one and "no limit"."""

    largest_nm: float
    no_limit_nm: float

    @classmethod
    def of(cls, signal: SignalSpec) -> CeilingCode:
        """Read the value table of ``signal``; "no limit" is its highest raw value."""
        no_limit_nm = signal.labels[NO_LIMIT_LABEL]
        return cls(no_limit_nm - signal.scale, no_limit_nm)

    def to_bus(self, limit_nm: float) -> float:
        """Value to encode; a ceiling that is not a number holds nothing, like infinity."""
        return min(limit_nm, self.largest_nm) if limit_nm < math.inf else self.no_limit_nm

    def from_bus(self, value_nm: float) -> float:
        """Ceiling meant by a decoded value."""
        return NO_LIMIT if value_nm >= self.no_limit_nm else value_nm


def ceiling_codes(message: MessageSpec) -> tuple[CeilingCode, CeilingCode]:
    """Codes of the left and the right motor's ceiling in the torque limit message."""
    left, right = (CeilingCode.of(message.signal(name)) for name in NO_LIMIT_SIGNALS)
    return left, right
