"""How a run went, from its recording: percentiles of the times, counts of the rest."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.protocol import SolveStatus
from tcs_hil.runtime.record import NO_LATENCY
from tcs_hil.signals import TcsState

US_PER_NS = 1e-3
US_PER_S = 1e6


@dataclass(frozen=True, slots=True)
class Percentiles:
    """Distribution of a time over the ticks of a run, in µs.

    Each percentile is a value that occurred: the smallest one that at least
    that share of the ticks does not exceed.
    """

    samples: int
    mean_us: float
    p50_us: float
    p99_us: float
    p99_9_us: float
    p99_99_us: float
    max_us: float


@dataclass(frozen=True, slots=True)
class Summary:
    """What one run did, tick by tick.

    A distribution is None where no tick had a value.  ``wake_jitter`` is wake minus
    scheduled time, ``latency`` receive time of the newest wheel-speed frame → send,
    ``solve`` the time of one wheel's control law, ``input_age`` that of the rear
    wheel speeds.  Statuses and solve times are of the wheels whose law was asked.
    """

    ticks: int
    overruns: int
    skipped: int
    failures: int
    bus_errors: int
    wake_jitter: Percentiles | None
    receive: Percentiles | None
    step: Percentiles | None
    send: Percentiles | None
    total: Percentiles | None
    latency: Percentiles | None
    solve: Percentiles | None
    input_age: Percentiles | None
    statuses: dict[str, int]
    states: dict[str, int]

    def as_dict(self) -> dict[str, Any]:
        """Return plain dicts, lists and numbers, fit for JSON."""
        return asdict(self)


def summarise(ticks: NDArray[np.void]) -> Summary:
    """Summarise ticks as ``recording.read`` returns them: (n,), n may be 0."""
    asked = ~np.isnan(_both(ticks, "proposal_{}_nm"))
    # A tick that met no new speeds has no latency of its own: the bus was silent, not we late.
    fresh = np.diff(ticks["wheel_stamp_ns"], prepend=0) != 0
    latency_ns = ticks["latency_ns"][fresh]
    age_s = ticks["rear_speed_age_s"]
    return Summary(
        ticks=len(ticks),
        overruns=int(ticks["overrun"].sum()),
        skipped=int(ticks["skipped"].sum()),
        failures=int(ticks["failed"].sum()),
        bus_errors=int(ticks["bus_errors"][-1]) if len(ticks) else 0,
        wake_jitter=_percentiles((ticks["wake_ns"] - ticks["scheduled_ns"]) * US_PER_NS),
        receive=_percentiles((ticks["received_ns"] - ticks["wake_ns"]) * US_PER_NS),
        step=_percentiles((ticks["stepped_ns"] - ticks["received_ns"]) * US_PER_NS),
        send=_percentiles((ticks["sent_ns"] - ticks["stepped_ns"]) * US_PER_NS),
        total=_percentiles((ticks["sent_ns"] - ticks["wake_ns"]) * US_PER_NS),
        latency=_percentiles(latency_ns[latency_ns != NO_LATENCY] * US_PER_NS),
        solve=_percentiles(_both(ticks, "solve_{}_ns")[asked] * US_PER_NS),
        input_age=_percentiles(age_s[np.isfinite(age_s)] * US_PER_S),
        statuses=_counts(_both(ticks, "status_{}")[asked], SolveStatus),
        states=_counts(ticks["state"], TcsState),
    )


def _percentiles(samples_us: NDArray[np.float64]) -> Percentiles | None:
    if not len(samples_us):
        return None
    p50, p99, p99_9, p99_99, largest = np.quantile(
        samples_us, (0.5, 0.99, 0.999, 0.9999, 1.0), method="inverted_cdf"
    ).tolist()
    mean = float(samples_us.mean())
    return Percentiles(len(samples_us), mean, p50, p99, p99_9, p99_99, largest)


def _both(ticks: NDArray[np.void], name: str) -> NDArray[Any]:
    """One field of both driven wheels, left then right: (2 n,)."""
    return np.concatenate([ticks[name.format(wheel)] for wheel in ("fl", "fr")])


def _counts(values: NDArray[Any], names: type[IntEnum]) -> dict[str, int]:
    """How often each member occurred; those that never did are left out."""
    found, counts = np.unique(values, return_counts=True)
    return {names(v).name: n for v, n in zip(found.tolist(), counts.tolist(), strict=True)}
