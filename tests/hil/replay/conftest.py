from pathlib import Path

import pytest

DATA = Path(__file__).parents[2] / "data"


@pytest.fixture(scope="session")
def kept() -> Path:
    """The recording that changes least: the PI law of the paper's preset on the bare car."""
    return DATA / "pi-paper"
