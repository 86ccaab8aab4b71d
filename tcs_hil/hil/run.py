"""One run on the bench: recorder, service and emulator as processes on one bus, or in one process.

Either way it leaves the same files, so whatever reads a run need not know its pace.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from plant_emulator.scenario import Scenario
from tcs_hil.hil.in_process import drive_in_process
from tcs_hil.hil.metrics import Truth
from tcs_hil.hil.processes.program import program
from tcs_hil.hil.toml import write_toml
from tcs_hil.runtime.recording import read
from tcs_hil.service.settings import ServiceConfig, TickSettings

Mode = Literal["lockstep", "real-time", "in-process"]
MODES: tuple[Mode, ...] = ("lockstep", "real-time", "in-process")

SERVICE_PHASE_US = 500
"""The service ticks this long after the plant: its frames have then arrived."""
SPARE_S = 30.0
SLOWEST_LOCKSTEP = 200.0
"""Times slower than real time that a busy machine may be; who waits in vain gives up by itself."""


@dataclass(frozen=True, slots=True)
class RunPlan:
    """What to run, at which pace, and the folder that keeps everything the run leaves.

    The bus is the configuration's; so is everything else about the service but
    what starts its ticks and where it records them.
    """

    scenario: Scenario
    config: ServiceConfig
    mode: Mode
    folder: Path


@dataclass(frozen=True, slots=True)
class RunFiles:
    """What a run leaves in ``folder``: scenario, configuration, bus, every tick, the truth."""

    folder: Path

    @property
    def scenario(self) -> Path:
        """The scenario as run, for `plant-emulator run --scenario`."""
        return self.folder / "scenario.toml"

    @property
    def config(self) -> Path:
        """The service as run, for `tcs-hil run --config`."""
        return self.folder / "service.toml"

    @property
    def bus(self) -> Path:
        """Every frame, as python-can reads it."""
        return self.folder / "bus.blf"

    @property
    def flight(self) -> Path:
        """The service's flight recording."""
        return self.folder / "flight.tcsrec"

    @property
    def truth(self) -> Path:
        """The plant's truth."""
        return self.folder / "truth.npz"

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
        TcsError: the bus cannot be opened or one of the programs failed; its log is
            in the folder.
    """
    plan.folder.mkdir(parents=True, exist_ok=True)
    files = RunFiles(plan.folder)
    files.flight.unlink(missing_ok=True)
    config = _as_run(plan, files)
    write_toml(files.scenario, plan.scenario.resolved())
    write_toml(files.config, config)
    if plan.mode == "in-process":
        drive_in_process(plan.scenario, config, files.bus, files.truth)
    else:
        _drive_processes(plan, files, config)
    return files


def _as_run(plan: RunPlan, files: RunFiles) -> ServiceConfig:
    config = plan.config
    recorded_s, tick = plan.scenario.duration_s, TickSettings(trigger="lockstep")
    if plan.mode == "real-time":  # the service ticks before the plant sets off, and after
        recorded_s += SPARE_S
        tick = replace(config.tick, trigger="timer", phase_us=SERVICE_PHASE_US)
    ticks = round(recorded_s / config.control.period_s) + 1
    recorder = replace(config.recorder, path=str(files.flight.absolute()), ticks=ticks)
    # Written down elsewhere than where it was read: its paths must not move with it.
    return replace(config, tick=tick, recorder=recorder).beside(Path.cwd())


def _drive_processes(plan: RunPlan, files: RunFiles, config: ServiceConfig) -> None:
    bus = ["--interface", config.bus.interface, "--channel", config.bus.channel]
    if config.bus.bitrate is not None:
        bus += ["--bitrate", str(config.bus.bitrate)]
    pace = "realtime" if plan.mode == "real-time" else "lockstep"
    plant = ("plant_emulator", "run", "--scenario", str(files.scenario), "--mode", pace)
    patience_s = plan.scenario.duration_s * (1.0 if pace == "realtime" else SLOWEST_LOCKSTEP)
    # Started first, stopped last: the recorder sees every frame.
    with (
        program("tcs_hil", "record", str(files.bus), *bus, log=plan.folder / "recorder.log"),
        program("tcs_hil", "run", "--config", str(files.config), log=plan.folder / "service.log"),
        program(*plant, "--record", str(files.truth), *bus, log=plan.folder / "plant.log") as car,
    ):
        car.wait(patience_s + SPARE_S)
