"""How a run went, from its recording: percentiles of the times, counts of the rest."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.protocol import SolveStatus
from tcs_hil.runtime.times import both_wheels, times_us, was_asked
from tcs_hil.signals import BusCondition, TcsState

NOTHING_HEARD = (
    "bit rate mismatch? The controller has met errors and not one good frame: compare the bit rate "
    "with the other nodes' (ip -details link), then look for wiring, termination and a node that "
    "acknowledges"
)
"""A wrong bit rate has no flag of its own.  Source: ISO 11898-1, fault confinement."""


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

    The distributions are those of ``times.times_us``, None where no tick had a
    value.  Statuses and solve times are of the wheels whose law was asked.
    ``advice`` is what is likely wrong with the bus, empty where nothing tells.
    """

    ticks: int
    overruns: int
    skipped: int
    failures: int
    bus_errors: int
    lost_frames: int
    e2e_errors: int
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
    advice: str

    def as_dict(self) -> dict[str, Any]:
        """Return plain dicts, lists and numbers, fit for JSON."""
        return asdict(self)


def summarise(ticks: NDArray[np.void]) -> Summary:
    """Summarise ticks as ``recording.read`` returns them: (n,), n may be 0."""
    asked = was_asked(ticks)
    times = {name: _percentiles(samples_us) for name, samples_us in times_us(ticks).items()}
    return Summary(
        ticks=len(ticks),
        overruns=int(ticks["overrun"].sum()),
        skipped=int(ticks["skipped"].sum()),
        failures=int(ticks["failed"].sum()),
        bus_errors=_newest(ticks, "bus_errors"),
        lost_frames=_newest(ticks, "lost_frames"),
        e2e_errors=_newest(ticks, "e2e_errors"),
        wake_jitter=times["wake_jitter"],
        receive=times["receive"],
        step=times["step"],
        send=times["send"],
        total=times["total"],
        latency=times["latency"],
        solve=times["solve"],
        input_age=times["input_age"],
        statuses=_counts(both_wheels(ticks, "status_{}")[asked], SolveStatus),
        states=_counts(ticks["state"], TcsState),
        advice=NOTHING_HEARD if _only_errors(ticks) else "",
    )


def _only_errors(ticks: NDArray[np.void]) -> bool:
    """Whether the controller fell ill on a bus from which no frame ever came."""
    ill = (BusCondition.ERROR_PASSIVE, BusCondition.BUS_OFF)
    return not _newest(ticks, "rx_frames") and bool(np.isin(ticks["bus_condition"], ill).any())


def _newest(ticks: NDArray[np.void], counter: str) -> int:
    return int(ticks[counter][-1]) if len(ticks) else 0


def _percentiles(samples_us: NDArray[np.float64]) -> Percentiles | None:
    if not len(samples_us):
        return None
    p50, p99, p99_9, p99_99, largest = np.quantile(
        samples_us, (0.5, 0.99, 0.999, 0.9999, 1.0), method="inverted_cdf"
    ).tolist()
    mean = float(samples_us.mean())
    return Percentiles(len(samples_us), mean, p50, p99, p99_9, p99_99, largest)


def _counts(values: NDArray[Any], names: type[IntEnum]) -> dict[str, int]:
    """How often each member occurred; those that never did are left out."""
    found, counts = np.unique(values, return_counts=True)
    return {names(v).name: n for v, n in zip(found.tolist(), counts.tolist(), strict=True)}
