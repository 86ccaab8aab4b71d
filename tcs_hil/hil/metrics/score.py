"""Everything a run is judged by, in one row."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_emulator.scenario import Scenario
from tcs_hil.hil.metrics.ideal import ideal_speed_gained_mps
from tcs_hil.hil.metrics.ideal_car import ideal_car
from tcs_hil.hil.metrics.limit_cycle import LimitCycle, find_limit_cycle
from tcs_hil.hil.metrics.slip import SlipMetrics, longest_spin_s, slip_metrics
from tcs_hil.hil.metrics.truth import Truth
from tcs_hil.model.vehicle import Vehicle

LEAST_IDEAL_MPS = 0.5
"""Below this the ideal run hardly accelerates, and a ratio to it says nothing."""


@dataclass(frozen=True, slots=True)
class Score:
    """One run.  ``gain_ratio`` is speed gained over ideal (eta_v), NaN where that is nearly 0."""

    slip: SlipMetrics
    gained_mps: float
    gain_ratio: float
    spin_s: float
    limit_cycle: LimitCycle | None


def score(truth: Truth, scenario: Scenario, reference: float, vehicle: Vehicle) -> Score:
    """Judge a run of ``scenario`` against the slip ``reference``."""
    gained_mps = float(truth["speed_mps"][-1] - truth["speed_mps"][0])
    ideal_mps = ideal_speed_gained_mps(scenario, float(truth["time_s"][-1]))
    power_w = ideal_car(scenario.vehicle).power_max_w
    return Score(
        slip=slip_metrics(truth, reference, vehicle, motor_power_w=power_w),
        gained_mps=gained_mps,
        gain_ratio=gained_mps / ideal_mps if ideal_mps >= LEAST_IDEAL_MPS else np.nan,
        spin_s=longest_spin_s(truth),
        limit_cycle=find_limit_cycle(truth),
    )
