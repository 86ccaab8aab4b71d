"""Every law lives through a recording of itself again and decides as it did.

Where a change of behaviour is meant: `python -m tests.data.regenerate`.
"""

from pathlib import Path

import pytest

from tcs_hil.hil.logs.sources import find_sources
from tcs_hil.hil.replay.recorded import Grid
from tcs_hil.hil.replay.session import recorded_config, replay_in_process
from tcs_hil.hil.replay.story import tell

RECORDINGS = sorted(path.parent for path in Path(__file__).parents[2].glob("data/*/bus.blf"))

STEP_NM = 0.05
"""Of a torque limit on the bus: another machine's solver may round the last bit otherwise."""
TOLERANCE_NM = {"pi": 0.0, "kmpc": STEP_NM, "nmpc": STEP_NM}


@pytest.mark.parametrize("folder", RECORDINGS, ids=lambda folder: folder.name)
def test_a_kept_recording_is_reproduced(folder: Path) -> None:
    sources = find_sources([folder])
    config = recorded_config(sources)
    verdict = replay_in_process(sources, config, TOLERANCE_NM[config.controller])
    assert verdict.grid is Grid.BENCH
    assert verdict.comparison.ticks == 600
    story = "\n".join(tell(verdict.ticks, verdict.comparison, verdict.database))
    assert verdict.comparison.same, story


def test_every_law_of_every_preset_is_kept() -> None:
    laws = {f"{law}-{preset}" for law in TOLERANCE_NM for preset in ("paper", "default")}
    assert {folder.name for folder in RECORDINGS} == laws


def test_a_kept_recording_is_small(kept: Path) -> None:
    assert (kept / "bus.blf").stat().st_size < 300_000
