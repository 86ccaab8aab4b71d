"""What the monitor shows of one instant."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec
import numpy as np


class Side(msgspec.Struct, frozen=True, kw_only=True):
    """One driven wheel and its motor; None is what the source does not tell.

    A ``limit_nm`` of None is no limit.
    """

    slip_ratio: float
    wheel_speed_radps: float
    rear_speed_radps: float
    request_nm: float
    limit_nm: float | None
    motor_nm: float
    mu_ratio: float | None = None
    mu_confidence: float | None = None

    @property
    def allowed_nm(self) -> float:
        """The lower of request and limit."""
        return self.request_nm if self.limit_nm is None else min(self.request_nm, self.limit_nm)


class Spread(msgspec.Struct, frozen=True):
    """How some times of the last seconds lie, µs."""

    p50_us: float
    p99_us: float
    max_us: float


class Snapshot(msgspec.Struct, frozen=True, kw_only=True):
    """One instant; ``silent_s`` says how long ago anything was heard, None for never.

    ``times`` and ``rates_hz`` cover the last two seconds and the last one,
    ``counts`` everything since the source was opened.
    """

    source: str
    silent_s: float | None
    state: str
    controller: str
    fault_code: int
    fault: str
    slip_reference: float | None
    vehicle_speed_mps: float | None
    left: Side
    right: Side
    times: dict[str, Spread]
    rates_hz: dict[str, float]
    counts: dict[str, int]


def spread(samples_us: Iterable[float]) -> Spread | None:
    """Median, 99th percentile and greatest of the samples; None of none."""
    values = np.fromiter(samples_us, float)
    if values.size == 0:
        return None
    return Spread(*(float(v) for v in np.percentile(values, [50, 99, 100])))
