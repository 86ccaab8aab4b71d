"""How well the slip of the driven wheels was held."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tcs_hil.hil.metrics.truth import FRONT, Truth
from tcs_hil.model.tyre import tyre_force_n
from tcs_hil.model.vehicle import Vehicle

SPINNING_RATIO = 0.6
"""Slip at which a wheel is lost: far beyond every tyre's peak."""


@dataclass(frozen=True, slots=True)
class SlipMetrics:
    """How well slip was held.  NaN where no sample counts.

    ``rmse_ratio`` and ``peak_ratio`` are of the true modified slip of the worse
    front wheel; ``chatter_nmps`` is the mean |dT/dt| of the motor torques.
    """

    rmse_ratio: float
    peak_ratio: float
    final_speed_mps: float
    chatter_nmps: float
    reachable_share: float


def slip_metrics(
    truth: Truth,
    reference: float,
    vehicle: Vehicle,
    up_to_mps: float = np.inf,
    motor_power_w: float = np.inf,
) -> SlipMetrics:
    """Judge a run against the slip ``reference``, leaving out speeds above ``up_to_mps``.

    RMSE counts the samples after the driver's first ramp in which the driver's
    torque can reach the reference (see ``reachable``).
    """
    ramp_end_s = _ramp_end_s(truth)
    counted = truth["speed_mps"] <= up_to_mps
    if not counted.all():  # copying the whole run takes milliseconds
        truth = truth[counted]
    slip = truth["slip_ratio"][:, FRONT]  # (n, 2)
    can_hold = reachable(truth, reference, vehicle, motor_power_w)
    counts = can_hold & (truth["time_s"] >= ramp_end_s)[:, None]
    return SlipMetrics(
        rmse_ratio=_worse_rms(np.where(counts, slip - reference, np.nan)),
        peak_ratio=float(slip.max()),
        final_speed_mps=float(truth["speed_mps"][-1]),
        chatter_nmps=_worse_rate(truth["motor_torque_nm"], truth["time_s"]),
        reachable_share=float(counts.mean()),
    )


def reachable(
    truth: Truth, reference: float, vehicle: Vehicle, motor_power_w: float = np.inf
) -> NDArray[np.bool_]:
    """Samples and front wheels (n, 2) in which the driver's torque can hold the reference.

    Holding it takes the tyre's force there plus what spins the wheel up with
    the car; there to take are the driver's request and what the motor's power
    gives at the speed of the reference.  The one place that decides which
    samples an RMSE may leave out.
    """
    nominal_n = tyre_force_n(reference, vehicle) / (vehicle.friction_ratio * vehicle.wheel_load_n)
    force_n = nominal_n * truth["mu"][:, FRONT] * truth["load_n"][:, FRONT]
    radius_m = vehicle.wheel_radius_m
    accel_mps2 = 4.0 / vehicle.mass_kg * force_n
    spin_up_nm = vehicle.wheel_inertia_kgm2 * accel_mps2 / (radius_m * (1.0 - reference))
    needed_nm = (force_n * radius_m + spin_up_nm) / vehicle.gear_ratio
    held_radps = vehicle.gear_ratio * truth["speed_mps"] / (radius_m * (1.0 - reference))
    power_nm = motor_power_w / np.maximum(held_radps, 1.0)
    return np.asarray(np.minimum(truth["request_nm"], power_nm)[:, None] >= needed_nm)


def longest_spin_s(truth: Truth, above_ratio: float = SPINNING_RATIO) -> float:
    """Longest time without a break that a front wheel's slip is above ``above_ratio``."""
    spins = truth["slip_ratio"][:, FRONT] > above_ratio  # (n, 2)
    return max(_longest_s(truth["time_s"], wheel) for wheel in spins.T)


def _longest_s(time_s: NDArray[np.float64], spins: NDArray[np.bool_]) -> float:
    edges = np.flatnonzero(np.diff(spins, prepend=False, append=False))
    starts, ends = edges[::2], edges[1::2] - 1  # first and last sample of each spin
    return float((time_s[ends] - time_s[starts]).max(initial=0.0))


def _ramp_end_s(truth: Truth) -> float:
    """When the request first stops rising; the end of the run if it never does."""
    request_nm = truth["request_nm"]
    rests = (request_nm[:-1] > 0.0) & (np.diff(request_nm) <= 0.0)
    return float(truth["time_s"][np.argmax(rests) if rests.any() else -1])


def _worse_rms(errors: NDArray[np.float64]) -> float:
    """Root mean square of each column (n, 2) over what is not NaN, the larger of the two."""
    counted = [column[~np.isnan(column)] for column in errors.T]
    return max((float(np.sqrt(np.mean(e**2))) for e in counted if e.size), default=np.nan)


def _worse_rate(torque_nm: NDArray[np.float64], time_s: NDArray[np.float64]) -> float:
    travelled_nm = np.abs(np.diff(torque_nm, axis=0)).sum(axis=0)
    return float((travelled_nm / (time_s[-1] - time_s[0])).max())
