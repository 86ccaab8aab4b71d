"""Makes the recordings anew that tests/hil/replay lets the service live through again.

Run it from the root of the project where a change of behaviour is meant, and say
in the commit why the recordings changed:

    python -m tests.data.regenerate
"""

from __future__ import annotations

import shutil
from pathlib import Path
from tempfile import TemporaryDirectory

from plant_emulator.scenario import Variant, load_scenario
from tcs_hil.config import read_toml
from tcs_hil.hil.run import RunFiles, RunPlan, execute
from tcs_hil.service.settings import ServiceConfig

HERE = Path(__file__).parent
CONFIG = """\
controller = "{controller}"

[control]
preset = "{preset}"
"""
RUNS: dict[str, Variant] = {
    "pi-paper": "quarter-car",
    "kmpc-paper": "quarter-car",
    "nmpc-paper": "quarter-car",
    "pi-default": "vehicle",
    "kmpc-default": "vehicle",
    "nmpc-default": "vehicle",
}
"""Law and preset, and the car they drove."""


def regenerate(name: str, variant: Variant) -> None:
    """Drive the launch once more; keep the bus and what the service was told."""
    kept = RunFiles(HERE / name)
    kept.folder.mkdir(exist_ok=True)
    controller, _, preset = name.partition("-")
    kept.config.write_text(CONFIG.format(controller=controller, preset=preset), encoding="utf-8")
    scenario = load_scenario(HERE / "launch.toml").with_variant(variant)
    config = read_toml(kept.config, ServiceConfig)
    with TemporaryDirectory() as folder:
        made = execute(RunPlan(scenario, config, "in-process", Path(folder)))
        shutil.copyfile(made.bus, kept.bus)


if __name__ == "__main__":
    for run, car in RUNS.items():
        regenerate(run, car)
        print(f"{run}: {RunFiles(HERE / run).bus.stat().st_size / 1e3:.0f} kB")
