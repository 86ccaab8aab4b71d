"""The ticks of a recorded service: when each was, what it heard and what it said."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

from tcs_hil.canbus.frame import Frame
from tcs_hil.signals import BusCondition

Answers = list[tuple[Frame, ...]]
"""What a service said, tick by tick."""


class Grid(Enum):
    """What said where the ticks of a recording are."""

    BENCH = "the bench's ticks"
    FLIGHT = "the flight recording"
    LIMITS = "the stamps of the torque limits, which tell its ticks only roughly"


class RecordedTick(NamedTuple):
    """One tick.

    ``now_ns`` is the time decisions were made with, ``inputs`` are stamped on the
    same clock; ``answers`` end with the torque limits.
    """

    number: int
    now_ns: int
    inputs: tuple[Frame, ...]
    answers: tuple[Frame, ...]
    bus: BusCondition = BusCondition.OK


class Recording(NamedTuple):
    """The ticks of a recording, oldest first, how they were found, and what was lost of it."""

    ticks: list[RecordedTick]
    grid: Grid
    lost: str = ""
