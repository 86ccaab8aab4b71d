"""The embedded bus does what every bus does."""

from __future__ import annotations

from tcs_hil.canbus.bus import open_bus

from .back_to_back import BackToBack


class TestEmbedded(BackToBack):
    def open_node(self):
        return open_bus("embedded", "vcan0")[0]
