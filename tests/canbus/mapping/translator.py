"""Between our emulator, which speaks our DBC, and a service that speaks a maker's."""

from __future__ import annotations

from factories import command

from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.tcs_node import TcsNode

from .makers import Car, Maker

Frame = tuple[int, bytes]


class Translator:
    """Turns the emulator's frames into the maker's, and the maker's limits into ours."""

    def __init__(self, maker: Maker) -> None:
        self._ears = TcsNode(load_database())
        self._car = Car(maker)

    def hear(self, frame_id: int, data: bytes, now_ns: int) -> None:
        """Take one frame of the emulator."""
        self._ears.feed(frame_id, data, now_ns)

    def speeds_and_requests(self, now_ns: int) -> list[Frame]:
        """What the maker's car says in this tick."""
        return self._car.frames(self._ears.measurement(now_ns))

    def limits(self, frame_id: int, data: bytes) -> Frame | None:
        """Our TorqueLimit in place of the maker's; None for any other frame."""
        limits = self._car.limits(frame_id, data)
        if limits is None:
            return None
        return self._ears.frames(command(*limits), 0)[-1]
