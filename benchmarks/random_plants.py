"""Random plants: does the loop hold on cars and roads that nobody tuned it for?

A plant is told by two numbers, the campaign's seed and its index, so that each
can be driven again alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import msgspec
import numpy as np

from plant_emulator.body import Body
from plant_emulator.bustiming import BusTiming
from plant_emulator.driveline import Driveline
from plant_emulator.driver import Driver
from plant_emulator.road import Patch
from plant_emulator.scenario import Scenario, VehicleTable
from plant_emulator.sensors import Sensors
from plant_emulator.tyre import Tyre
from tcs_hil.hil.batch import Job, Progress, judge_all
from tcs_hil.hil.metrics import Score
from tcs_hil.service.settings import ServiceConfig

DURATION_S = 3.0
JUMP_S = 1.5
"""About when the friction jumps: half the run on either side."""
TIP_IN = Driver(request=((0.1, 0.0), (0.35, 250.0)))
LONGEST_SPIN_S = 0.2


class Sample(msgspec.Struct, frozen=True):
    """What is drawn for one plant; everything else is as in the default car."""

    seed: int
    index: int
    mass_kg: float
    shaft_stiffness_nmprad: float
    shaft_damping_nmsprad: float
    motor_lag_s: float
    limit_delay_s: float
    relaxation_m: float
    teeth: int
    mu_before: float
    mu_after: float
    scaling: Literal["shape", "peak"]
    start_speed_kmph: float


@dataclass(frozen=True, slots=True)
class Trial:
    """One plant and what came of it."""

    sample: Sample
    score: Score

    @property
    def oscillates(self) -> bool:
        """Whether the run has a limit cycle."""
        return self.score.limit_cycle is not None

    @property
    def spins(self) -> bool:
        """Whether a front wheel was lost, slip above 0.6, for more than 0.2 s."""
        return self.score.spin_s > LONGEST_SPIN_S


def draw(seed: int, index: int) -> Sample:
    """Draw the plant ``index`` of campaign ``seed``, everything uniformly."""
    rng = np.random.default_rng((seed, index))
    return Sample(
        seed=seed,
        index=index,
        mass_kg=rng.uniform(0.8, 1.2) * Body().mass_kg,
        shaft_stiffness_nmprad=rng.uniform(3e3, 10e3),
        shaft_damping_nmsprad=rng.uniform(8.0, 30.0),
        motor_lag_s=rng.uniform(2e-3, 20e-3),
        limit_delay_s=rng.uniform(0.0, 10e-3),
        relaxation_m=rng.uniform(0.1, 0.4),
        teeth=int(rng.integers(44, 97)),
        mu_before=rng.uniform(0.08, 0.6),
        mu_after=rng.uniform(0.08, 0.6),
        scaling="peak" if rng.integers(2) else "shape",
        start_speed_kmph=rng.uniform(0.0, 150.0),
    )


def scenario_of(sample: Sample) -> Scenario:
    """A tip-in to full torque within 0.25 s, held for 3 s, over one jump of friction."""
    return Scenario(
        description=f"Plant {sample.index} of campaign {sample.seed}",
        driver=TIP_IN,
        duration_s=DURATION_S,
        start_speed_kmph=sample.start_speed_kmph,
        vehicle=_vehicle(sample),
        road=(
            Patch(mu=sample.mu_before, scaling=sample.scaling),
            Patch(from_m=_jump_m(sample), mu=sample.mu_after, scaling=sample.scaling),
        ),
        sensors=Sensors(teeth=sample.teeth, seed=sample.index),
        bus=BusTiming(limit_delay_s=sample.limit_delay_s),
    )


def run_campaign(
    config: ServiceConfig, samples: Sequence[Sample], progress: Progress
) -> list[Trial]:
    """Drive every plant under the service ``config`` describes, on every core.

    Raises:
        TcsError: the configuration cannot be used.
    """
    jobs = [Job(f"plant {sample.index}", scenario_of(sample), config) for sample in samples]
    scores = judge_all(jobs, progress)
    return [Trial(sample, score) for sample, score in zip(samples, scores, strict=True)]


def worst(trials: Sequence[Trial], count: int) -> list[Trial]:
    """The ``count`` runs one would look at first: lost wheels, then limit cycles, then RMSE."""
    return sorted(trials, key=_badness, reverse=True)[:count]


def _badness(trial: Trial) -> tuple[bool, bool, float]:
    rmse = trial.score.slip.rmse_ratio
    return trial.spins, trial.oscillates, 0.0 if np.isnan(rmse) else rmse


def _vehicle(sample: Sample) -> VehicleTable:
    return VehicleTable(
        variant="vehicle",
        body=Body(mass_kg=sample.mass_kg),
        tyre=Tyre(relaxation_m=sample.relaxation_m),
        driveline=Driveline(
            motor_lag_s=sample.motor_lag_s,
            shaft_stiffness_nmprad=sample.shaft_stiffness_nmprad,
            shaft_damping_nmsprad=sample.shaft_damping_nmsprad,
        ),
    )


def _jump_m(sample: Sample) -> float:
    """Where a front-driven car is at ``JUMP_S`` if it uses the friction before: half of mu g."""
    driven_s = JUMP_S - 0.2
    launch_m = 0.5 * (0.5 * sample.mu_before * 9.81) * driven_s**2
    return sample.start_speed_kmph / 3.6 * JUMP_S + launch_m
