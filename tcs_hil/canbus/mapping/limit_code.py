"""How a ceiling of one motor is said in a signal that was not made for us."""

from __future__ import annotations

import math
from dataclasses import dataclass

from tcs_hil.canbus.codec import SignalSpec
from tcs_hil.canbus.mapping.findings import MapFault


@dataclass(frozen=True, slots=True)
class LimitCode:
    """What the signal can say, in Nm of one motor; ``no_limit_nm`` is a code, not a torque."""

    smallest_nm: float
    largest_nm: float
    no_limit_nm: float

    def to_bus(self, limit_nm: float) -> float:
        """Value to encode; a ceiling that is not a number holds nothing, like infinity."""
        if not limit_nm < math.inf:
            return self.no_limit_nm
        return min(max(limit_nm, self.smallest_nm), self.largest_nm)


def limit_code(spec: SignalSpec, no_limit_raw: int | None, key: str) -> LimitCode:
    """Set one raw value apart; without one the highest torque stands for "no limit".

    Raises:
        MapFault: The values grow against the torque, or the code lies among them.
    """
    if spec.scale <= 0:
        raise MapFault(key, f"the values of {spec.name} must grow with the torque")
    low, high = spec.raw_range
    if low >= high:
        raise MapFault(key, f"the range of {spec.name} leaves room for no torque")
    code = high if no_limit_raw is None else no_limit_raw
    if low < code < high:
        raise MapFault(
            f"{key}.no_limit_raw", f"raw value {code} is a torque; it must be an end of the range"
        )
    smallest = low + 1 if code == low else low
    largest = high - 1 if code == high and no_limit_raw is not None else high
    nm = [steps * spec.scale + spec.offset for steps in (smallest, largest, code)]
    return LimitCode(*nm)
