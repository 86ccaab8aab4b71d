"""A real SocketCAN interface does what every bus does."""

from __future__ import annotations

import pytest

from tcs_hil.canbus.bus import open_bus
from tests.canbus.back_to_back import BackToBack


@pytest.mark.vcan
class TestSocketCan(BackToBack):
    def open_node(self):
        return open_bus("socketcan", "vcan0")[0]
