"""The times of recorded ticks, each defined once: for tables, histograms and metrics."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tcs_hil.runtime.record import NO_LATENCY

US_PER_NS = 1e-3
US_PER_S = 1e6

Times = dict[str, NDArray[np.float64]]


def times_us(ticks: NDArray[np.void], wheel_stamp_before_ns: int = 0) -> Times:
    """Every kind of time in ticks as ``recording.read`` returns them, (n,), in µs.

    ``wake_jitter`` is wake minus scheduled time, ``total`` wake to sent, ``latency``
    receive time of the newest wheel-speed frame to send, ``solve`` the time of one
    wheel's control law, ``input_age`` that of the rear wheel speeds.  Ticks that
    have no such time are left out: (m,), m may be 0, for ``solve`` up to 2 n.
    ``wheel_stamp_before_ns`` is that of the tick before these, if there was one.
    """
    return _stages_us(ticks) | {
        "latency": _latencies_us(ticks, wheel_stamp_before_ns),
        "solve": both_wheels(ticks, "solve_{}_ns")[was_asked(ticks)] * US_PER_NS,
        "input_age": _finite(ticks["rear_speed_age_s"]) * US_PER_S,
    }


def both_wheels(ticks: NDArray[np.void], name: str) -> NDArray[Any]:
    """One field of both driven wheels, left then right: (2 n,)."""
    return np.concatenate([ticks[name.format(wheel)] for wheel in ("fl", "fr")])


def was_asked(ticks: NDArray[np.void]) -> NDArray[np.bool_]:
    """Whose control law was asked, left then right: (2 n,)."""
    asked: NDArray[np.bool_] = ~np.isnan(both_wheels(ticks, "proposal_{}_nm"))
    return asked


def _stages_us(ticks: NDArray[np.void]) -> Times:
    def between(begin: str, end: str) -> NDArray[np.float64]:
        duration_us: NDArray[np.float64] = (ticks[f"{end}_ns"] - ticks[f"{begin}_ns"]) * US_PER_NS
        return duration_us

    return {
        "wake_jitter": between("scheduled", "wake"),
        "receive": between("wake", "received"),
        "step": between("received", "stepped"),
        "send": between("stepped", "sent"),
        "total": between("wake", "sent"),
    }


def _latencies_us(ticks: NDArray[np.void], before_ns: int) -> NDArray[np.float64]:
    # A tick that met no new speeds has no latency of its own: the bus was silent, not we late.
    fresh = np.diff(ticks["wheel_stamp_ns"], prepend=before_ns) != 0
    latency_ns = ticks["latency_ns"][fresh]
    return latency_ns[latency_ns != NO_LATENCY] * US_PER_NS  # type: ignore[no-any-return]


def _finite(values: NDArray[np.float64]) -> NDArray[np.float64]:
    return values[np.isfinite(values)]
