from pathlib import Path

import pytest
from hil.logs.made_run import made_run

from tcs_hil.hil.export.gather import gather
from tcs_hil.hil.export.table import Run
from tcs_hil.hil.logs.sources import find_sources


@pytest.fixture(scope="session")
def lockstep(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return made_run(tmp_path_factory.mktemp("made") / "lockstep", lockstep=True).folder


@pytest.fixture(scope="session")
def real_time(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return made_run(tmp_path_factory.mktemp("made") / "real-time", lockstep=False).folder


@pytest.fixture
def run(lockstep: Path) -> Run:
    """The lockstep run, gathered."""
    return gather(find_sources([lockstep]))


@pytest.fixture
def loose_run(real_time: Path) -> Run:
    """The run in real time, gathered."""
    return gather(find_sources([real_time]))
