"""What the inverters are asked for: the lower of the driver's request and the torque limit."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

from plant_emulator.compiled import compiled
from tcs_hil.signals import Pair


class Demand(NamedTuple):
    """What each motor is asked for over one piece of time, as straight lines from its start."""

    request_nm: Pair
    request_nmps: Pair
    limit_nm: Pair
    limit_nmps: Pair


Lines: TypeAlias = tuple[Pair, ...]
"""A demand without its names, which Python hands to compiled code in a third of the time."""


@compiled
def demanded(demand: Demand, elapsed_s: float) -> Pair:
    """Torque asked of the left and the right motor: the lower of request and limit."""
    return (
        min(
            demand.request_nm[0] + demand.request_nmps[0] * elapsed_s,
            demand.limit_nm[0] + demand.limit_nmps[0] * elapsed_s,
        ),
        min(
            demand.request_nm[1] + demand.request_nmps[1] * elapsed_s,
            demand.limit_nm[1] + demand.limit_nmps[1] * elapsed_s,
        ),
    )
