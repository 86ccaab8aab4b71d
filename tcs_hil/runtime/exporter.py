"""Metrics of a running service for Prometheus, from its flight recording alone.

The service knows nothing of it: a scrape costs the tick nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import accumulate
from threading import Lock

import numpy as np
from prometheus_client import Metric
from prometheus_client.core import (
    CounterMetricFamily,
    GaugeMetricFamily,
    HistogramMetricFamily,
    InfoMetricFamily,
)
from prometheus_client.registry import Collector

from tcs_hil.runtime.follower import BOUNDS_US, Follower, Histogram, Totals
from tcs_hil.runtime.recording import RecordingError
from tcs_hil.signals import TcsState

S_PER_US = 1e-6
S_PER_NS = 1e-9

TIMES = {
    "wake_jitter": "Wake minus scheduled time of each tick.",
    "receive": "Time to drain and decode the bus.",
    "step": "Time from measurement to command.",
    "send": "Time to encode and send.",
    "total": "Time from wake to sent.",
    "latency": "Receive time of the newest wheel-speed frame to our frames sent.",
    "solve": "Time of one wheel's control law.",
    "input_age": "Age of the rear wheel speeds when decisions are made.",
}
OWN_COUNTERS = {
    "rx_frames": "Frames received.",
    "tx_frames": "Frames sent.",
    "bus_errors": "Error frames, failed receives and failed sends.",
    "lost_frames": "Frames the kernel's receive buffer had no room for.",
    "e2e_errors": "Frames with a wrong checksum or data id.",
    "e2e_repeated": "Frames whose counter stood still.",
    "e2e_wrong_sequence": "Frames whose counter jumped.",
}
PER_WHEEL = {
    "slip_ratio": ("slip_ratio_{}", "Slip as estimated."),
    "torque_limit_nm": ("limit_{}_nm", "Torque ceiling sent; infinite is no limit."),
    "driver_torque_nm": ("driver_torque_{}_nm", "The driver's request."),
}


class FlightCollector(Collector):
    """Turns the newest state of a recording into metrics, each time Prometheus asks.

    ``now_ns`` is CLOCK_MONOTONIC.  Without a readable recording only ``tcs_hil_up``
    is there, and zero.
    """

    def __init__(self, follower: Follower, now_ns: Callable[[], int]) -> None:
        self._follower = follower
        self._now_ns = now_ns
        self._lock = Lock()  # two scrapers may come at once

    def collect(self) -> Iterator[Metric]:
        """Yield every metric as it is now."""
        with self._lock:
            try:
                totals = self._follower.totals()
            except RecordingError:
                yield _gauge("up", "Whether there is a flight recording to read.", 0)
                return
            yield _gauge("up", "Whether there is a flight recording to read.", 1)
            yield from _of_the_run(totals)
            if totals.newest is not None:
                yield from _of_the_newest(totals.newest, self._now_ns())


def _of_the_run(totals: Totals) -> Iterator[Metric]:
    run = totals.run
    yield InfoMetricFamily(
        "tcs_hil_run", "Which run this is.", {"controller": run.controller, "bus": run.bus}
    )
    yield _counter("ticks", "Ticks made.", totals.ticks)
    yield _counter("unseen_ticks", "Ticks the recording dropped before a scrape.", totals.unseen)
    yield _counter("overruns", "Ticks that ended after their deadline.", totals.overruns)
    yield _counter("skipped_ticks", "Points of the grid passed over.", totals.skipped)
    yield _counter("failed_ticks", "Ticks in which our own code failed.", totals.failures)
    for name, histogram in totals.times.items():
        yield _histogram(name, histogram)


def _of_the_newest(tick: np.void, now_ns: int) -> Iterator[Metric]:
    for name, what in OWN_COUNTERS.items():
        yield _counter(name, what, int(tick[name]))
    age_s = (now_ns - int(tick["sent_ns"])) * S_PER_NS
    yield _gauge("last_tick_age_seconds", "Time since the newest tick.", age_s)
    yield _gauge("fault_code", "Fault of the supervisor; zero is none.", int(tick["fault_code"]))
    yield _gauge("bus_condition", "Condition of the bus; zero is fine.", int(tick["bus_condition"]))
    yield _gauge("vehicle_speed_mps", "As estimated.", float(tick["vehicle_speed_mps"]))
    yield _state(TcsState(tick["state"]))
    for name, (template, what) in PER_WHEEL.items():
        yield _per_wheel(tick, name, template, what)


def _state(present: TcsState) -> Metric:
    family = GaugeMetricFamily("tcs_hil_state", "1 for the present state.", labels=["state"])
    for state in TcsState:
        family.add_metric([state.name], float(state is present))
    return family


def _per_wheel(tick: np.void, name: str, field: str, what: str) -> Metric:
    family = GaugeMetricFamily(f"tcs_hil_{name}", what, labels=["wheel"])
    for wheel in ("fl", "fr"):
        family.add_metric([wheel], float(tick[field.format(wheel)]))
    return family


def _counter(name: str, what: str, value: int) -> Metric:
    return CounterMetricFamily(f"tcs_hil_{name}", what, value=value)


def _gauge(name: str, what: str, value: float) -> Metric:
    return GaugeMetricFamily(f"tcs_hil_{name}", what, value=value)


def _histogram(name: str, histogram: Histogram) -> Metric:
    bounds = [*(f"{bound_us * S_PER_US:g}" for bound_us in BOUNDS_US), "+Inf"]
    counts = accumulate(histogram.bins.tolist())
    return HistogramMetricFamily(
        f"tcs_hil_{name}_seconds",
        TIMES[name],
        buckets=list(zip(bounds, counts, strict=True)),
        sum_value=histogram.sum_us * S_PER_US,
    )
