"""A private place for embedded channels, so that tests meet nobody else."""

from __future__ import annotations

import tempfile
from pathlib import Path

import pytest


@pytest.fixture(autouse=True)
def private_runtime_directory(monkeypatch):
    # Not tmp_path: the name of a UNIX socket has at most 107 characters.
    with tempfile.TemporaryDirectory(prefix="can-") as directory:
        monkeypatch.setenv("XDG_RUNTIME_DIR", directory)
        yield Path(directory)
