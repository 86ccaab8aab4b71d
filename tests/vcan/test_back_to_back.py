"""A real SocketCAN interface does what every bus does."""

from __future__ import annotations

import pytest

from tcs_hil.canbus.bus import open_bus
from tcs_hil.errors import BusError
from tests.canbus.back_to_back import BackToBack


@pytest.mark.vcan
class TestSocketCan(BackToBack):
    def open_node(self):
        return open_bus("socketcan", "vcan0")[0]

    def test_a_bit_rate_is_refused_as_it_is_set_elsewhere(self):
        with pytest.raises(BusError, match="bitrate 500000: has no effect on socketcan vcan0; `ip"):
            open_bus("auto", "vcan0", bitrate=500_000)
