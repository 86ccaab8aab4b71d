"""Figures of merit of one run, from the plant's truth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tcs_hil.model.vehicle import Vehicle
from tcs_hil.model.wheel import tyre_force_n

Truth = NDArray[np.void]
"""Rows of ``plant_emulator.truth.TRUTH_DTYPE``, one per tick."""

RAMP_END_S = 0.6
FRONT = slice(0, 2)


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
    truth: Truth, reference: float, vehicle: Vehicle, up_to_mps: float = np.inf
) -> SlipMetrics:
    """Judge a run against the slip ``reference``, leaving out speeds above ``up_to_mps``.

    RMSE counts the samples after the paper's torque ramp in which the driver's
    torque can reach the reference (see ``reachable``).
    """
    truth = truth[truth["speed_mps"] <= up_to_mps]
    slip = truth["slip_ratio"][:, FRONT]  # (n, 2)
    counts = reachable(truth, reference, vehicle) & (truth["time_s"] >= RAMP_END_S)[:, None]
    errors = np.where(counts, slip - reference, np.nan)
    return SlipMetrics(
        rmse_ratio=_worse(np.sqrt(np.nanmean(errors**2, axis=0))) if counts.any() else np.nan,
        peak_ratio=float(slip.max()),
        final_speed_mps=float(truth["speed_mps"][-1]),
        chatter_nmps=_worse(_mean_rate(truth["motor_torque_nm"], truth["time_s"])),
        reachable_share=float(counts.mean()),
    )


def reachable(truth: Truth, reference: float, vehicle: Vehicle) -> NDArray[np.bool_]:
    """Samples and front wheels (n, 2) in which the driver's torque can hold the reference.

    Holding it takes the tyre's force there plus what spins the wheel up with
    the car.  The one place that decides which samples an RMSE may leave out.
    """
    nominal_n = tyre_force_n(reference, vehicle) / (vehicle.friction_ratio * vehicle.wheel_load_n)
    force_n = nominal_n * truth["mu"][:, FRONT] * truth["load_n"][:, FRONT]
    radius_m = vehicle.wheel_radius_m
    accel_mps2 = 4.0 / vehicle.mass_kg * force_n
    spin_up_nm = vehicle.wheel_inertia_kgm2 * accel_mps2 / (radius_m * (1.0 - reference))
    needed_nm = (force_n * radius_m + spin_up_nm) / vehicle.gear_ratio
    return np.asarray(truth["request_nm"][:, None] >= needed_nm)


def _mean_rate(torque_nm: NDArray[np.float64], time_s: NDArray[np.float64]) -> NDArray[np.float64]:
    travelled_nm = np.abs(np.diff(torque_nm, axis=0)).sum(axis=0)
    return np.asarray(travelled_nm / (time_s[-1] - time_s[0]))


def _worse(per_wheel: NDArray[np.float64]) -> float:
    return float(np.max(per_wheel))
