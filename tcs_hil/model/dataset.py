"""The paper's data set: many short simulated runs of one wheel under random torque."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from tcs_hil.model.ranges import Period, Range
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.model.wheel import rk4_step, stable_substeps

FloatArray = NDArray[np.float64]
Progress = Callable[[float], None]
"""Called with the fraction of the work that is done, in [0, 1]."""


class DatasetSettings(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Excitation of the data set; the defaults are the paper's."""

    trajectories: Annotated[int, msgspec.Meta(ge=1, le=10_000)] = 1000
    samples: Annotated[int, msgspec.Meta(ge=1, le=1_000)] = 250
    period_s: Period = 0.002
    initial_speed_mps: Range = (0.0, 40.0 / 3.6)
    initial_slip_ratio: Range = (0.0, 0.2)
    torque_nm: Range = (50.0, 175.0)

    def __post_init__(self) -> None:
        for name in ("initial_speed_mps", "initial_slip_ratio", "torque_nm"):
            low, high = getattr(self, name)
            if not low < high:
                raise ValueError(f"{name} must rise, not run from {low} to {high}")
        if self.initial_speed_mps[0] < 0.0 or self.initial_slip_ratio[1] >= 1.0:
            raise ValueError("initial speed must be at least 0 and initial slip ratio below 1")


class Dataset(NamedTuple):
    """Triples (x, u, x⁺) of all runs, one after the other: x = [s m/s, omega rad/s]."""

    x: FloatArray  # (n, 2)
    u: FloatArray  # (n, 1), motor torque in Nm held from x to x_next
    x_next: FloatArray  # (n, 2)


def generate(
    vehicle: Vehicle, settings: DatasetSettings, seed: int, progress: Progress | None = None
) -> Dataset:
    """Simulate the data set; the same seed gives the same data.

    The torque is redrawn at every sample: held over a run it leaves A and B
    indistinguishable in part, and the predictor is useless.  A start at v = 0
    needs no special case: omega is 0 too, the modified slip is 0 there, and the
    torque, always positive, drives the wheel forwards from the first sample.
    """
    rng = np.random.default_rng(seed)
    torque = rng.uniform(*settings.torque_nm, (settings.samples, settings.trajectories))
    states = np.empty((settings.samples + 1, settings.trajectories, 2))
    substeps = stable_substeps(vehicle, settings.period_s)
    states[0] = _initial_states(vehicle, settings, rng)
    for k in range(settings.samples):
        states[k + 1] = rk4_step(states[k], torque[k], vehicle, settings.period_s, substeps)
        if progress is not None:
            progress((k + 1) / settings.samples)
    x, x_next = (part.swapaxes(0, 1).reshape(-1, 2) for part in (states[:-1], states[1:]))
    return Dataset(x, torque.T.reshape(-1, 1), x_next)


def _initial_states(
    vehicle: Vehicle, settings: DatasetSettings, rng: np.random.Generator
) -> FloatArray:
    """Draw [s, omega] (trajectories, 2) from vehicle speed and the plain slip ratio."""
    speed = rng.uniform(*settings.initial_speed_mps, settings.trajectories)
    kappa = rng.uniform(*settings.initial_slip_ratio, settings.trajectories)
    return state_at(speed, kappa, vehicle)


def state_at(speed_mps: FloatArray, kappa: FloatArray, vehicle: Vehicle) -> FloatArray:
    """State [s, omega] (n, 2) at a vehicle speed and a plain slip ratio (omega R - v)/(omega R)."""
    rim_speed_mps = speed_mps / (1.0 - kappa)
    return np.stack((rim_speed_mps - speed_mps, rim_speed_mps / vehicle.wheel_radius_m), axis=-1)
