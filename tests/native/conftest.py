"""Every test here needs the native step built."""

from __future__ import annotations

import pytest
from needs import needs

from tcs_hil import native


@pytest.fixture(autouse=True)
def _built() -> None:
    needs(native.is_built(), "the native step: a C compiler when this was installed")
