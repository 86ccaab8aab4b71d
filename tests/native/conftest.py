"""The tests of the native step need it built; where it is not they say so and are left out."""

from __future__ import annotations

import pytest

from tcs_hil import native


@pytest.fixture(autouse=True)
def _built() -> None:
    if not native.is_built():
        pytest.skip("no native step was built in this installation")
