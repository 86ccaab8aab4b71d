"""pytest plug-in: the fixture ``hil`` drives a scenario, and a test says what it expects of it.

Imported by every pytest in the environment, so it imports nothing heavy itself.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from tcs_hil.hil.driven_run import Driver


@pytest.fixture
def hil(tmp_path: Path) -> Driver:
    """Drive shipped scenarios or files into ``tmp_path``.

    As in ``run = hil("launch-mu-030", controller="kmpc")``, and then
    ``run.expect("peak slip", "<", 0.3)``.
    """
    from tcs_hil.hil.driven_run import Driver  # noqa: PLC0415 - see above

    return Driver(tmp_path)
