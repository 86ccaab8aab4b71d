import math
from pathlib import Path

import pytest

from benchmarks.random_plants import JUMP_S, Sample, Trial, draw, run_campaign, scenario_of, worst
from benchmarks.random_plants_figure import save_campaign_figure
from tcs_hil.hil.metrics import LimitCycle, Score, SlipMetrics
from tcs_hil.hil.simulation import simulate
from tcs_hil.service.settings import ServiceConfig

RANGES = {
    "mass_kg": (1120.0, 1680.0),
    "shaft_stiffness_nmprad": (3e3, 10e3),
    "shaft_damping_nmsprad": (8.0, 30.0),
    "motor_lag_s": (0.002, 0.020),
    "limit_delay_s": (0.0, 0.010),
    "relaxation_m": (0.1, 0.4),
    "teeth": (44, 96),
    "mu_before": (0.08, 0.6),
    "mu_after": (0.08, 0.6),
    "start_speed_kmph": (0.0, 150.0),
}
SAMPLES = [draw(1, index) for index in range(300)]


def trial(
    sample: Sample, rmse: float = 0.01, spin_s: float = 0.0, cycle: LimitCycle | None = None
) -> Trial:
    return Trial(sample, Score(SlipMetrics(rmse, 0.1, 5.0, 50.0, 0.8), 5.0, 0.98, spin_s, cycle))


@pytest.mark.parametrize(("name", "bounds"), RANGES.items())
def test_every_parameter_fills_its_range_and_stays_in_it(
    name: str, bounds: tuple[float, float]
) -> None:
    values = [getattr(sample, name) for sample in SAMPLES]
    low, high = bounds
    assert low <= min(values) < low + 0.05 * (high - low)
    assert high - 0.05 * (high - low) < max(values) <= high


def test_both_ways_friction_scales_a_tyre_are_drawn() -> None:
    assert {sample.scaling for sample in SAMPLES} == {"shape", "peak"}


def test_seed_and_index_tell_a_plant() -> None:
    assert draw(1, 7) == draw(1, 7)
    assert draw(1, 7) != draw(1, 8)
    assert draw(1, 7) != draw(2, 7)


def test_what_is_drawn_is_what_is_driven() -> None:
    sample = draw(3, 5)
    scenario = scenario_of(sample)
    assert scenario.vehicle.body.mass_kg == sample.mass_kg
    assert scenario.vehicle.driveline.shaft_stiffness_nmprad == sample.shaft_stiffness_nmprad
    assert scenario.vehicle.driveline.shaft_damping_nmsprad == sample.shaft_damping_nmsprad
    assert scenario.vehicle.driveline.motor_lag_s == sample.motor_lag_s
    assert scenario.vehicle.tyre.relaxation_m == sample.relaxation_m
    assert scenario.bus_timing.limit_delay_s == sample.limit_delay_s
    assert scenario.sensors.teeth == sample.teeth
    assert [patch.mu for patch in scenario.road] == [sample.mu_before, sample.mu_after]
    assert {patch.scaling for patch in scenario.road} == {sample.scaling}
    assert scenario.start_speed_kmph == sample.start_speed_kmph


@pytest.mark.parametrize("index", range(3))
def test_friction_jumps_about_half_way_through(index: int) -> None:
    sample = draw(1, index)
    truth = simulate(scenario_of(sample), ServiceConfig(controller="off")).truth
    jump = truth["time_s"][truth["mu"][:, 0] == sample.mu_after][0]
    assert jump == pytest.approx(JUMP_S, abs=0.4)


def test_a_campaign_drives_every_plant_and_says_how_far_it_is() -> None:
    told: list[tuple[float, str]] = []
    trials = run_campaign(
        ServiceConfig(controller="off"), SAMPLES[:2], lambda *progress: told.append(progress)
    )
    assert [each.sample for each in trials] == SAMPLES[:2]
    assert told == [(0.5, "plant 0"), (1.0, "plant 1")]
    assert all(math.isfinite(each.score.gained_mps) for each in trials)


def test_a_plant_driven_again_gives_the_same_score() -> None:
    config = ServiceConfig(controller="pi")
    first, second = (simulate(scenario_of(draw(1, 3)), config).truth for _ in range(2))
    assert (first == second).all()


def test_a_wheel_may_spin_for_200_ms_and_no_longer() -> None:
    assert not trial(SAMPLES[0], spin_s=0.2).spins
    assert trial(SAMPLES[0], spin_s=0.202).spins


def test_the_worst_runs_are_lost_wheels_then_limit_cycles_then_large_errors() -> None:
    cycle = LimitCycle("slip_ratio", 0, 1.0, 10.0, 0.2)
    lost = trial(SAMPLES[0], spin_s=0.5)
    cycling = trial(SAMPLES[1], cycle=cycle)
    poor = trial(SAMPLES[2], rmse=0.2)
    unreachable = trial(SAMPLES[3], rmse=math.nan)
    assert worst([unreachable, poor, cycling, lost], 3) == [lost, cycling, poor]


def test_the_map_of_a_campaign_shows_every_kind_of_run(tmp_path: Path) -> None:
    cycle = LimitCycle("slip_ratio", 0, 1.0, 10.0, 0.2)
    calm, cycling, lost = (
        trial(SAMPLES[0]),
        trial(SAMPLES[1], cycle=cycle),
        trial(SAMPLES[2], spin_s=1.0),
    )
    maps = []
    for trials in ([calm], [calm, cycling], [calm, cycling, lost]):
        save_campaign_figure(tmp_path / "map.png", "Three plants", trials)
        maps.append((tmp_path / "map.png").read_bytes())
    assert maps[0] != maps[1] != maps[2]
    assert maps[2].startswith(b"\x89PNG")
