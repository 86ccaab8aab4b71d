"""Faults as a scenario lists them: what, on whom, from when to when."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Annotated, Literal

from msgspec import Meta

from plant_emulator.bounds import NonNegative, Positive, Ratio, Table

Kind = Literal[
    "off",
    "stuck",
    "garbage",
    "wrong",
    "slow",
    "delayed",
    "intermittent",
    "dropped",
    "duplicated",
    "bit-flip",
    "wrong-crc",
    "frozen-counter",
    "bus-off",
    "babbling",
    "ignores-limit",
    "tooth-missing",
    "brown-out",
]

VALUE_KINDS = {"off", "stuck", "garbage", "wrong", "slow", "delayed", "intermittent"}
FRAME_KINDS = {"dropped", "duplicated", "bit-flip", "delayed", "intermittent"}
PROTECTED_KINDS = FRAME_KINDS | {"wrong-crc", "frozen-counter"}

WHEELS = ("WheelSpeedFL", "WheelSpeedFR", "WheelSpeedRL", "WheelSpeedRR")
SIGNALS = (
    *WHEELS,
    "MotorSpeedL",
    "MotorSpeedR",
    "MotorTorqueL",
    "MotorTorqueR",
    "DriverTorqueRequestL",
    "DriverTorqueRequestR",
    "VehicleAccelX",
)
MESSAGES = (
    "DriverRequest",
    "MotorState",
    "WheelSpeedsFront",
    "WheelSpeedsRear",
    "TorqueLimit",
)
UNPROTECTED = ("TcsStatus",)
MOTORS = ("MotorL", "MotorR")
NODES = ("VEHICLE", "TCS")

_KINDS_OF = {
    **dict.fromkeys(SIGNALS, VALUE_KINDS),
    **dict.fromkeys(WHEELS, VALUE_KINDS | {"tooth-missing"}),
    **dict.fromkeys(MESSAGES, PROTECTED_KINDS),
    **dict.fromkeys(UNPROTECTED, FRAME_KINDS),
    **dict.fromkeys(MOTORS, VALUE_KINDS | {"ignores-limit"}),
    "VEHICLE": {"bus-off", "babbling", "brown-out"},
    "TCS": {"bus-off"},
}


class Fault(Table, frozen=True):
    """One fault on a signal, message, motor or node, named as in the DBC.

    ``low`` and ``high`` bound garbage; ``offset`` and ``scale`` make a value wrong;
    ``time_constant_s`` is how slow, ``delay_s`` how late; an intermittent fault
    is there for ``duty`` of every ``period_s``; ``probability`` picks frames;
    ``bit`` is the bit that flips (a random one if absent); ``tooth`` the tooth
    that is missing; a babbling node sends ``frame_id`` every ``period_s``.
    """

    target: str
    kind: Kind
    start_s: NonNegative = 0.0
    end_s: Positive | None = None
    low: float = 0.0
    high: float = 300.0
    offset: float = 0.0
    scale: float = 1.0
    time_constant_s: Positive = 0.1
    delay_s: Positive = 0.02
    period_s: Annotated[float, Meta(ge=0.0002)] = 0.02
    duty: Ratio = 0.5
    probability: Ratio = 1.0
    bit: Annotated[int, Meta(ge=0, le=63)] | None = None
    tooth: Annotated[int, Meta(ge=0)] = 0
    frame_id: Annotated[int, Meta(ge=0, le=0x7FF)] = 0x001

    def __post_init__(self) -> None:
        """Refuse an unknown target, a kind it cannot have and a fault that never is."""
        if self.target not in _KINDS_OF:
            raise ValueError(f"`target` {self.target!r} is no signal, message, motor or node")
        if self.kind not in _KINDS_OF[self.target]:
            raise ValueError(f"`kind` {self.kind!r} does not exist for `target` {self.target!r}")
        if self.end <= self.start_s:
            raise ValueError("`end_s` must be greater than `start_s`")

    @property
    def end(self) -> float:
        """When it ends; infinite for a fault that lasts."""
        return math.inf if self.end_s is None else self.end_s

    def active(self, time_s: float) -> bool:
        """Whether the fault is there at ``time_s``."""
        if not self.start_s <= time_s < self.end:
            return False
        if self.kind != "intermittent":
            return True
        return (time_s - self.start_s) % self.period_s < self.duty * self.period_s


def next_boundary(faults: Iterable[Fault], time_s: float) -> float:
    """First start or end of any of ``faults`` after ``time_s``; infinite if there is none."""
    edges = (edge for fault in faults for edge in (fault.start_s, fault.end))
    return min((edge for edge in edges if edge > time_s), default=math.inf)
