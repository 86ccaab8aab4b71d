"""A recording replayed onto a real vcan0, where a service of its own process answers it."""

from pathlib import Path

import pytest
from msgspec.structs import replace

from plant_emulator.scenario import load_scenario
from tcs_hil.control.settings import ControlSettings
from tcs_hil.hil.logs.sources import Sources, find_sources
from tcs_hil.hil.processes.program import program
from tcs_hil.hil.replay.recorded import Grid
from tcs_hil.hil.replay.session import Verdict, recorded_config, replay_live
from tcs_hil.hil.replay.story import tell
from tcs_hil.hil.run import SERVICE_PHASE_US, RunPlan, execute
from tcs_hil.service.settings import BusSettings, RecorderSettings, ServiceConfig

from .conftest import CHANNEL

SHORT = RecorderSettings(ticks=5000)
"""Enough for these runs: a guest kernel maps locked memory page by page, and runs out of maps."""

KEPT = Path(__file__).parents[1] / "data" / "pi-paper"


def answered(sources: Sources, tmp_path: Path, *options: str, within_nm: float = 0.0) -> Verdict:
    """What a fresh service says to a recording, beside what the recorded one had said."""
    config = recorded_config(sources)
    on_vcan0 = replace(config, bus=BusSettings(interface="socketcan", channel=CHANNEL))
    law = ("--controller", "pi", "--preset", "paper")
    short = tmp_path / "short.toml"
    short.write_text(f"[recorder]\nticks = {SHORT.ticks}\n")
    service = ("tcs_hil", "run", "--config", str(short), *law, "--channel", CHANNEL, *options)
    with program(*service, log=tmp_path / "answering.log"):
        return replay_live(sources, on_vcan0, within_nm)


def story(verdict: Verdict) -> str:
    return "\n".join(tell(verdict.ticks, verdict.comparison, verdict.database))


def test_in_lockstep_a_service_gives_the_recorded_answers(tmp_path: Path) -> None:
    verdict = answered(find_sources([KEPT]), tmp_path, "--trigger", "lockstep")
    assert verdict.comparison.ticks == 600
    assert verdict.comparison.same, story(verdict)


@pytest.mark.simulated_time
def test_in_real_time_a_service_gives_the_recorded_answers(tmp_path: Path) -> None:
    scenario = replace(load_scenario("manoeuvre-1"), duration_s=0.5)
    config = ServiceConfig(controller="pi", control=ControlSettings(preset="paper"), recorder=SHORT)
    files = execute(RunPlan(scenario, config, "real-time", tmp_path / "run"))
    phase = ("--phase-us", str(SERVICE_PHASE_US))
    # On the last tick, when the plant falls silent, one step of the signal was seen to differ.
    verdict = answered(find_sources([files.folder]), tmp_path, *phase, within_nm=0.051)
    assert verdict.grid is Grid.FLIGHT
    assert verdict.comparison.ticks > 240
    assert verdict.comparison.same, story(verdict)
