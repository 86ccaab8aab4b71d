"""The control laws on random plants: how often a run ends in a limit cycle or with a lost wheel.

python -m benchmarks.campaign                         500 plants, both MPCs
python -m benchmarks.campaign --law pi --plants 100   fewer, another law
python -m benchmarks.campaign --law nmpc --only 137   one plant again, with a picture
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import click
import numpy as np

from benchmarks.laws import DEFAULTS, LAWS
from benchmarks.options import json_option, law_option, write_option
from benchmarks.random_plants import Sample, Trial, draw, run_campaign, scenario_of, worst
from benchmarks.random_plants_figure import save_campaign_figure
from benchmarks.section import markdown, tell
from tcs_hil.cli.progress import progress_bar
from tcs_hil.control.settings import ControlSettings
from tcs_hil.hil.figures import Line, save_slip_figure
from tcs_hil.hil.simulation import simulate

WORST = 8
SHARES = (
    "law",
    "plants",
    "without limit cycle",
    "slip > 0.6 for > 200 ms",
    "RMSE p50 / p95 / max",
    "speed gained / ideal p50 / p5 / min",
)
PLANT = (
    "plant",
    "v0 km/h",
    "mu",
    "mass kg",
    "shaft Nm/rad, Nms/rad",
    "lag ms",
    "delay ms",
    "relaxation m",
    "teeth",
    "found",
)


def shares(name: str, trials: Sequence[Trial]) -> list[str]:
    """One law's row of the first table."""
    rmse = [trial.score.slip.rmse_ratio for trial in trials]
    gain = [trial.score.gain_ratio for trial in trials]
    calm = sum(not trial.oscillates for trial in trials)
    return [
        name,
        f"{len(trials)}",
        f"{calm / len(trials):.1%}",
        f"{sum(trial.spins for trial in trials)}",
        _percentiles(rmse, (50, 95, 100)),
        _percentiles(gain, (50, 5, 0)),
    ]


def plant(trial: Trial) -> list[str]:
    """One plant's row of the second table: what was drawn and what was found."""
    sample = trial.sample
    return [
        f"{sample.index}",
        f"{sample.start_speed_kmph:.0f}",
        f"{sample.mu_before:.2f} → {sample.mu_after:.2f} ({sample.scaling})",
        f"{sample.mass_kg:.0f}",
        f"{sample.shaft_stiffness_nmprad:.0f}, {sample.shaft_damping_nmsprad:.0f}",
        f"{sample.motor_lag_s * 1e3:.1f}",
        f"{sample.limit_delay_s * 1e3:.1f}",
        f"{sample.relaxation_m:.2f}",
        f"{sample.teeth}",
        finding(trial),
    ]


def finding(trial: Trial) -> str:
    """What is wrong with a run, or its RMSE."""
    found = [f"RMSE {trial.score.slip.rmse_ratio:.3f}"]
    if trial.spins:
        found.append(f"slip > 0.6 for {trial.score.spin_s * 1e3:.0f} ms")
    if cycle := trial.score.limit_cycle:
        found.append(f"{cycle.signal} {cycle.frequency_hz:.0f} Hz from {cycle.start_s:.1f} s")
    return ", ".join(found)


def report(campaign: dict[str, list[Trial]]) -> list[str]:
    """Shares of every law, then the worst plants of each, as Markdown."""
    lines = markdown(SHARES, (shares(name, trials) for name, trials in campaign.items()))
    for name, trials in campaign.items():
        chosen = worst(trials, WORST)
        lines += ["", f"Worst plants of {name}:", "", *markdown(PLANT, map(plant, chosen))]
        sample = chosen[0].sample
        again = f"python -m benchmarks.campaign --law {name} --seed {sample.seed}"
        lines += ["", f"Drive one again: `{again} --only {sample.index}`"]
    return lines


def draw_figure(sample: Sample, laws: Iterable[str]) -> Path:
    """Slip and torque of one plant under each law."""
    path = Path(f"campaign-{sample.seed}-plant-{sample.index}.png")
    scenario = scenario_of(sample)
    configs = [LAWS[name] for name in laws]
    runs = [
        Line(config.controller, config.control.preset, simulate(scenario, config).truth)
        for config in configs
    ]
    save_slip_figure(path, scenario.description, runs, ControlSettings().slip_reference)
    return path


def draw_maps(folder: Path, campaign: dict[str, list[Trial]]) -> list[str]:
    """A picture per law of where its bad runs lie, and the lines that show them on a page."""
    lines = []
    images = folder / "images"
    images.mkdir(exist_ok=True)
    for name, trials in campaign.items():
        path = images / f"campaign-{name}.png"
        save_campaign_figure(path, f"{len(trials)} random plants under {name}", trials)
        lines += ["", f"![Plants on which {name} fails]({path.relative_to(folder).as_posix()})"]
    return lines


def _percentiles(values: Sequence[float], percents: Sequence[float]) -> str:
    known = [value for value in values if not np.isnan(value)]
    return " / ".join(f"{v:.3f}" for v in np.percentile(known, percents)) if known else "-"


@click.command()
@law_option(DEFAULTS)
@click.option("--plants", type=click.IntRange(1), default=500, show_default=True)
@click.option("--seed", type=click.IntRange(0), default=1, show_default=True)
@click.option("--only", type=click.IntRange(0), help="Drive and draw the plant of this index.")
@json_option
@write_option
def main(
    laws: tuple[str, ...],
    plants: int,
    seed: int,
    only: int | None,
    machine_readable: bool,
    write: Path | None,
) -> None:
    """Drive random plants under each law and count what must not happen."""
    samples = [draw(seed, index) for index in (range(plants) if only is None else [only])]
    campaign = {}
    for name in laws:
        with progress_bar(name) as advance:
            campaign[name] = run_campaign(LAWS[name], samples, advance)
    lines = report(campaign)
    if only is not None:
        lines += ["", f"Figure: {draw_figure(samples[0], laws)}"]
    if write:
        lines += draw_maps(write.parent, campaign)
    trials = [(name, trial) for name in laws for trial in campaign[name]]
    tell("benchmarks.campaign", lines, write, trials if machine_readable else None)


if __name__ == "__main__":
    main()
