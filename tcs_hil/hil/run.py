"""One run on the bench: recorder, service and emulator as processes on one bus."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.settings import PresetName
from tcs_hil.hil.metrics import Truth
from tcs_hil.hil.processes import program
from tcs_hil.runtime.recording import read

Mode = Literal["realtime", "lockstep"]

SERVICE_PHASE_US = 500
"""The service ticks this long after the plant: its frames have then arrived."""
RUN_TIMEOUT_S = 120.0
SERVICE_CONFIG = "[recorder]\nticks = 20_000\n"
"""Room for 40 s: a recording of the default length would cost 100 MB for each run."""


@dataclass(frozen=True, slots=True)
class RunPlan:
    """What to run, on which bus, and the folder that keeps everything the run leaves."""

    scenario: str
    vehicle: str
    controller: str
    mode: Mode
    folder: Path
    interface: str = "auto"
    channel: str = "vcan0"
    preset: PresetName = "default"


@dataclass(frozen=True, slots=True)
class RunFiles:
    """What a run leaves on disk: the configuration, the bus, every tick, the plant's truth."""

    config: Path
    bus: Path
    flight: Path
    truth: Path

    def read_truth(self) -> Truth:
        """Rows of the plant's truth, one per tick."""
        with np.load(self.truth) as recording:
            rows: Truth = recording["truth"]
        return rows

    def read_flight(self) -> NDArray[np.void]:
        """Ticks of the service, oldest first."""
        return read(self.flight)


def execute(plan: RunPlan) -> RunFiles:
    """Run the plan to the end of its scenario.

    Raises:
        ProcessError: one of the three programs failed; its log is in the folder.
    """
    plan.folder.mkdir(parents=True, exist_ok=True)
    files = RunFiles(
        *(plan.folder / name for name in ("service.toml", "bus.blf", "flight.tcsrec", "truth.npz"))
    )
    files.flight.unlink(missing_ok=True)
    files.config.write_text(SERVICE_CONFIG)
    bus = ("--interface", plan.interface, "--channel", plan.channel)
    # Started first, stopped last: the recorder sees every frame.
    with (
        program("tcs_hil", "record", str(files.bus), *bus, log=plan.folder / "recorder.log"),
        program(*_service(plan, files), *bus, log=plan.folder / "service.log"),
        program(*_plant(plan, files), *bus, log=plan.folder / "plant.log") as plant,
    ):
        plant.wait(RUN_TIMEOUT_S)
    return files


def _service(plan: RunPlan, files: RunFiles) -> tuple[str, ...]:
    trigger = "timer" if plan.mode == "realtime" else "lockstep"
    return (
        *(
            "tcs_hil",
            "run",
            "--config",
            str(files.config),
            "--controller",
            plan.controller,
            "--preset",
            plan.preset,
            "--trigger",
            trigger,
        ),
        *("--phase-us", str(SERVICE_PHASE_US), "--flight-recording", str(files.flight)),
    )


def _plant(plan: RunPlan, files: RunFiles) -> tuple[str, ...]:
    return (
        *("plant_emulator", "run", "--scenario", plan.scenario, "--vehicle", plan.vehicle),
        *("--mode", plan.mode, "--record", str(files.truth)),
    )
