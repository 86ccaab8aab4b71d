"""What a port hands over and what it counts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple


class Frame(NamedTuple):
    """A classic data frame and when it came, on CLOCK_MONOTONIC."""

    frame_id: int
    data: bytes
    stamp_ns: int


@dataclass(slots=True)
class PortCounters:
    """Everything a port has met; errors are counted here and raised nowhere.

    ``dropped`` are frames nobody here speaks: extended identifiers and CAN FD.
    ``lost`` are frames for which the kernel's receive buffer had no room; only
    SocketCAN tells.
    """

    rx: int = 0
    tx: int = 0
    error_frames: int = 0
    remote_frames: int = 0
    dropped: int = 0
    lost: int = 0
    rx_errors: int = 0
    tx_errors: int = 0
    reopened: int = 0
