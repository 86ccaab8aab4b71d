"""Faults on frames, and on the nodes that send and hear them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from tcs_hil.fault_codes import FaultCode as Code
from tcs_hil.hil.faults.cell import Cell, Promise
from tcs_hil.hil.faults.promises import (
    BEHIND,
    BRIDGED,
    ECHO,
    UNREAD,
    late,
    lost,
    nothing,
)
from tcs_hil.signals import TcsState

LASTS_CYCLES = 150
LONGEST_S = 0.6


class Input(NamedTuple):
    """A message that decisions rest on, and what the service calls its absence."""

    cycle_s: float
    late: Code
    lost: tuple[Code, ...]
    state: TcsState = TcsState.FAULT

    @property
    def lasts_s(self) -> float:
        """Long enough for the worst state, and for the E2E window to fill."""
        return min(LASTS_CYCLES * self.cycle_s, LONGEST_S)


INPUTS = {
    "WheelSpeedsFront": Input(
        0.002, Code.FRONT_SPEED_LATE, (Code.FRONT_SPEED_LOST, Code.FRONT_SPEED_CORRUPT)
    ),
    "WheelSpeedsRear": Input(
        0.002, Code.REAR_SPEED_LATE, (Code.REAR_SPEED_LOST, Code.REAR_SPEED_CORRUPT)
    ),
    "DriverRequest": Input(
        0.010, Code.DRIVER_REQUEST_LATE, (Code.DRIVER_REQUEST_LOST, Code.DRIVER_REQUEST_CORRUPT)
    ),
    "MotorState": Input(
        0.002, Code.MOTOR_STATE_LATE, (Code.MOTOR_STATE_CORRUPT,), TcsState.DEGRADED
    ),
}
OUTPUTS = {"TorqueLimit": BEHIND, "TcsStatus": UNREAD}

BROKEN: dict[str, tuple[str, Mapping[str, float]]] = {
    "dropped": ("dropped", {}),
    "bit flips": ("bit-flip", {}),
    "wrong CRC": ("wrong-crc", {}),
    "frozen counter": ("frozen-counter", {}),
}
"""No frame is good."""

SILENCE = [code for each in INPUTS.values() for code in (each.late, *each.lost)]
VEHICLE = lost(0.002, *SILENCE)


def frame_cells() -> Iterator[Cell]:
    """Every kind a frame's fault can have, on every message; then the nodes."""
    for message, about in INPUTS.items():
        yield from _of_input(message, about)
    for message, why in OUTPUTS.items():
        yield from _of_output(message, nothing(why))
    yield Cell("bus-off", ("VEHICLE",), "bus-off", VEHICLE, 0.3)
    yield Cell("brown-out", ("VEHICLE",), "brown-out", VEHICLE, 0.3)
    yield Cell("babbling", ("VEHICLE",), "babbling", VEHICLE, 0.3, {"period_s": 0.0003})
    yield Cell("bus-off", ("TCS",), "bus-off", nothing(BEHIND), 0.3)


def _of_input(message: str, about: Input) -> Iterator[Cell]:
    cycle_s, target = about.cycle_s, (message,)
    gone = lost(cycle_s, about.late, *about.lost, state=about.state)
    for family, (kind, numbers) in BROKEN.items():
        yield Cell(family, target, kind, gone, about.lasts_s, numbers)
    shortly, bridged = late(cycle_s, about.late), nothing(BRIDGED)
    sometimes = nothing(BRIDGED, about.late)
    yield Cell("two lost", target, "dropped", bridged, 2 * cycle_s)
    yield Cell("eight lost", target, "dropped", shortly, 8 * cycle_s)
    yield Cell("a third lost", target, "dropped", sometimes, about.lasts_s, {"probability": 0.33})
    yield Cell("twice", target, "duplicated", nothing(ECHO), about.lasts_s)
    delay = {"delay_s": 3 * cycle_s}
    yield Cell("three cycles late", target, "delayed", sometimes, about.lasts_s, delay)
    contact = {"period_s": 25 * cycle_s, "duty": 0.36}
    yield Cell("nine of 25 lost", target, "intermittent", shortly, about.lasts_s, contact)


def _of_output(message: str, promise: Promise) -> Iterator[Cell]:
    contact = {"period_s": 0.05, "duty": 0.36}
    for family, (kind, numbers) in BROKEN.items():
        if message != "TcsStatus" or kind in ("dropped", "bit-flip"):
            yield Cell(family, (message,), kind, promise, 0.3, numbers)
    yield Cell("twice", (message,), "duplicated", promise, 0.3)
    yield Cell("20 ms late", (message,), "delayed", promise, 0.3, {"delay_s": 0.02})
    yield Cell("nine of 25 lost", (message,), "intermittent", promise, 0.3, contact)
