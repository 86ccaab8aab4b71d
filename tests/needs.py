"""What a test needs of the machine: left out where that is missing, an error in CI."""

from __future__ import annotations

import os
from typing import TypeVar

import pytest

IN_CI = os.environ.get("CI") == "true"
T = TypeVar("T")


def needs(found: T | None, what: str) -> T:
    """Hand on what was found; where nothing was, skip the running test, or fail it in CI."""
    if not found:
        (pytest.fail if IN_CI else pytest.skip)(f"needs {what}")
    return found
