"""Metrics of a whole run: the wheels' slip, the car's gain, the service's limits and times."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.protocol import SolveStatus
from tcs_hil.hil.judging.evidence import Evidence
from tcs_hil.hil.judging.measured import CannotJudgeError, Measured
from tcs_hil.hil.metrics import (
    SlipMetrics,
    Truth,
    find_limit_cycle,
    ideal_speed_gained_mps,
    longest_spin_s,
    slip_metrics,
)
from tcs_hil.hil.metrics.ideal_car import ideal_car
from tcs_hil.hil.metrics.score import LEAST_IDEAL_MPS
from tcs_hil.hil.metrics.truth import FRONT
from tcs_hil.runtime.times import both_wheels, times_us

UNSOLVED = (SolveStatus.FAILED, SolveStatus.BAD_INPUT)


@dataclass(frozen=True, slots=True)
class Stretch:
    """A window of a run; ``ticks`` and ``truth`` are of it alone, and not empty."""

    evidence: Evidence
    truth: Truth
    ticks: NDArray[np.void]
    tick_time_s: NDArray[np.float64]

    @property
    def slip(self) -> SlipMetrics:
        """The paper's figures of it."""
        config, car = self.evidence.config, ideal_car(self.evidence.scenario.vehicle)
        reference, power_w = config.control.slip_reference, car.power_max_w
        return slip_metrics(self.truth, reference, config.vehicle, motor_power_w=power_w)


@dataclass(frozen=True, slots=True)
class RunMetric:
    """How to measure; ``clocked`` needs a run in real time, ``whole`` knows no window."""

    measure: Callable[[Stretch], Measured]
    unit: str
    about: str
    clocked: bool = False
    whole: bool = False


def stretch(evidence: Evidence, from_s: float, to_s: float) -> Stretch:
    """Cut a window out of a run.

    Raises:
        CannotJudgeError: the run had ended by then.
    """
    truth, tick_time_s = evidence.truth, evidence.tick_time_s
    truth = truth[(truth["time_s"] >= from_s) & (truth["time_s"] <= to_s)]
    inside = (tick_time_s >= from_s) & (tick_time_s <= min(to_s, evidence.heard_until_s))
    if not len(truth) or not inside.any():
        raise CannotJudgeError(f"the run ended at {evidence.end_s:.3f} s, before the window")
    return Stretch(evidence, truth, evidence.ticks[inside], tick_time_s[inside])


def _slip_rmse(run: Stretch) -> Measured:
    rmse = run.slip.rmse_ratio
    if np.isnan(rmse):
        raise CannotJudgeError("the driver's torque never reaches the slip reference")
    return Measured(rmse)


def _peak_slip(run: Stretch) -> Measured:
    slip = run.truth["slip_ratio"][:, FRONT].max(axis=1)
    worst = int(np.argmax(slip))
    return Measured(float(slip[worst]), float(run.truth["time_s"][worst]))


def _longest_spin(run: Stretch) -> Measured:
    return Measured(longest_spin_s(run.truth))


def _limit_cycles(run: Stretch) -> Measured:
    found = find_limit_cycle(run.truth)
    if found is None:
        return Measured(0.0)
    side = ("left", "right")[found.side]
    note = f"{found.signal} {side}: {found.frequency_hz:.0f} Hz, swing {found.swing:.3g}"
    return Measured(1.0, found.start_s, note)


def _speed_gained(run: Stretch) -> Measured:
    speed_mps = run.truth["speed_mps"]
    return Measured(float(speed_mps[-1] - speed_mps[0]))


def _speed_gained_ratio(run: Stretch) -> Measured:
    ideal_mps = ideal_speed_gained_mps(run.evidence.scenario, run.evidence.end_s)
    if ideal_mps < LEAST_IDEAL_MPS:
        raise CannotJudgeError(f"the ideal car gains {ideal_mps:.2f} m/s: no ratio to that")
    gained_mps = _speed_gained(run).value
    return Measured(gained_mps / ideal_mps, None, f"{gained_mps:.2f} of {ideal_mps:.2f} m/s")


def _torque_rate(run: Stretch) -> Measured:
    return Measured(run.slip.chatter_nmps)


def _limit_above_request(run: Stretch) -> Measured:
    """The service may only lower torque: its ceilings against the request as it knew it."""
    limit_nm, request_nm = (
        np.column_stack([run.ticks[name.format(wheel)] for wheel in ("fl", "fr")])
        for name in ("limit_{}_nm", "driver_torque_{}_nm")
    )
    above_nm = np.where(np.isposinf(limit_nm), -np.inf, limit_nm - request_nm).max(axis=1)
    worst = int(np.argmax(above_nm))
    value = float(above_nm[worst])
    if np.isneginf(value):
        return Measured(0.0, None, "no limit was set")
    return Measured(value, float(run.tick_time_s[worst]))


def _lowest_limit(run: Stretch) -> Measured:
    limit_nm = np.minimum(run.ticks["limit_fl_nm"], run.ticks["limit_fr_nm"])
    worst = int(np.argmin(limit_nm))
    return Measured(float(limit_nm[worst]), float(run.tick_time_s[worst]))


def _count(field: str) -> Callable[[Stretch], Measured]:
    """Ticks of which ``field`` is set, or the sum over them."""

    def measure(run: Stretch) -> Measured:
        values = run.ticks[field].astype(float)
        first = float(run.tick_time_s[np.argmax(values > 0.0)]) if values.any() else None
        return Measured(float(values.sum()), first)

    return measure


def _increase(field: str) -> Callable[[Stretch], Measured]:
    """How far a counter of the service went up."""

    def measure(run: Stretch) -> Measured:
        return Measured(float(run.ticks[field][-1] - run.ticks[field][0]))

    return measure


def _solver_failures(run: Stretch) -> Measured:
    return Measured(float(np.isin(both_wheels(run.ticks, "status_{}"), UNSOLVED).sum()))


def _percentile(name: str, share: float) -> Callable[[Stretch], Measured]:
    def measure(run: Stretch) -> Measured:
        samples_us = times_us(run.ticks)[name]
        if not len(samples_us):
            raise CannotJudgeError("no tick of the window has such a time")
        return Measured(float(np.quantile(samples_us, share, method="inverted_cdf")))

    return measure


PERCENTILES = {"p50": 0.5, "p99": 0.99, "p99.9": 0.999, "max": 1.0}
TIMES = {
    "latency": ("latency", "newest wheel speeds in to limit out", True),
    "jitter": ("wake_jitter", "woken to scheduled", True),
    "tick time": ("total", "woken to last frame sent", True),
    "solve time": ("solve", "control law of one wheel", False),
    "input age": ("input_age", "age of the rear wheel speeds", False),
}

RUN_METRICS = {
    "slip RMSE": RunMetric(
        _slip_rmse,
        "",
        "distance of the worse front wheel's slip from the reference where it can be held",
    ),
    "peak slip": RunMetric(_peak_slip, "", "largest slip of a front wheel"),
    "longest spin": RunMetric(_longest_spin, "s", "longest time a front wheel's slip is above 0.6"),
    "limit cycles": RunMetric(_limit_cycles, "", "1 if slip or torque keeps swinging, else 0"),
    "speed gained": RunMetric(_speed_gained, "m/s", "speed at the end less speed at the begin"),
    "speed gained ratio": RunMetric(
        _speed_gained_ratio, "", "speed gained over what the tyres' peak would give", whole=True
    ),
    "mean |dT/dt|": RunMetric(_torque_rate, "Nm/s", "of the worse motor's torque"),
    "limit above request": RunMetric(
        _limit_above_request, "Nm", "largest limit less the driver's request, as the service saw it"
    ),
    "lowest limit": RunMetric(_lowest_limit, "Nm", "smallest limit sent"),
    "overruns": RunMetric(_count("overrun"), "", "ticks that ended after their deadline", True),
    "skipped ticks": RunMetric(_count("skipped"), "", "grid points passed over", True),
    "failed ticks": RunMetric(_count("failed"), "", "ticks in which the service's code raised"),
    "solver failures": RunMetric(_solver_failures, "", "steps for which a law found no torque"),
    "lost frames": RunMetric(_increase("lost_frames"), "", "frames the kernel had no room for"),
    "E2E errors": RunMetric(_increase("e2e_errors"), "", "frames with a wrong checksum"),
} | {
    f"{name} {percentile}": RunMetric(_percentile(field, share), "µs", about, clocked)
    for (name, (field, about, clocked)), (percentile, share) in product(
        TIMES.items(), PERCENTILES.items()
    )
}
