"""One short run, driven once for everybody who judges it."""

from __future__ import annotations

import uuid
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from plant_emulator.driver import Driver
from plant_emulator.road import Patch
from plant_emulator.scenario import Scenario
from tcs_hil.hil.judging.evidence import Evidence
from tcs_hil.hil.run import Mode, RunPlan, execute
from tcs_hil.service.settings import BusSettings, ServiceConfig

LAUNCH = Scenario(
    description="a launch on snow, cut short",
    duration_s=0.5,
    start_speed_kmph=5.0,
    road=(Patch(mu=0.3),),
    driver=Driver(request=((0.05, 0.0), (0.25, 250.0))),
)
_folder = TemporaryDirectory(prefix="tcs-hil-tests.")


@cache
def launch(mode: Mode = "in-process") -> Evidence:
    """The launch under the PI; each mode is driven once."""
    bus = BusSettings(interface="embedded", channel=f"vcan-{uuid.uuid4().hex[:8]}")
    config = ServiceConfig(controller="pi", bus=bus)
    plan = RunPlan(LAUNCH, config, mode, Path(_folder.name) / mode)
    return Evidence(execute(plan), LAUNCH, config, mode)
