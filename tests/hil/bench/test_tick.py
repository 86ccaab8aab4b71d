"""The service's loop on recorded frames."""

from __future__ import annotations

import pytest

from tcs_hil.control.settings import ControlSettings
from tcs_hil.hil.bench.controllers import drive_of
from tcs_hil.hil.bench.tick import STAGES, cost_of_ticks
from tcs_hil.service.settings import ServiceConfig

TICKS = 150


@pytest.mark.parametrize("preset", ["paper", "default"])
def test_every_stage_of_every_tick_is_timed(preset: str) -> None:
    ticks = drive_of("manoeuvre-1", "KMPC", preset).ticks[:TICKS]
    config = ServiceConfig(control=ControlSettings(preset=preset))
    cost = cost_of_ticks(config, ticks, repeats=2)
    assert cost.whole.cpu.samples == 2 * TICKS
    assert tuple(cost.stages) == STAGES
    # The laws were asked: the frames were good, and the supervisor let them.
    assert cost.stages["solve"].samples > 2 * TICKS
    whole = cost.whole.wall.mean_us
    parts = sum(cost.stages[name].mean_us for name in ("receive", "step", "send", "record"))
    assert parts == pytest.approx(whole, rel=0.01)
