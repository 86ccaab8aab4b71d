"""Faults as a scenario lists them: what, on whom, from when to when."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Annotated, Literal

from msgspec import Meta

from plant_emulator.bounds import TEETH_MAX, Finite, NonNegative, Positive, Ratio, Table
from tcs_hil.errors import offer

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
LIMITS = ("TorqueLimitL", "TorqueLimitR")
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
    **dict.fromkeys((*SIGNALS, *LIMITS), VALUE_KINDS),
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
    low: Finite = 0.0
    high: Finite = 300.0
    offset: Finite = 0.0
    scale: Finite = 1.0
    time_constant_s: Positive = 0.1
    delay_s: Annotated[float, Meta(gt=0.0, le=60.0)] = 0.02
    period_s: Annotated[float, Meta(ge=0.0002, le=3600.0)] = 0.02
    duty: Ratio = 0.5
    probability: Ratio = 1.0
    bit: Annotated[int, Meta(ge=0, le=63)] | None = None
    tooth: Annotated[int, Meta(ge=0, lt=TEETH_MAX)] = 0
    frame_id: Annotated[int, Meta(ge=0, le=0x7FF)] = 0x001

    def __post_init__(self) -> None:
        """Refuse an unknown target, a kind it cannot have and a fault that never is."""
        if self.target not in _KINDS_OF:
            hint = offer(self.target, _KINDS_OF)
            raise ValueError(f"`target` {self.target!r} is no signal, message, motor or node{hint}")
        if self.kind not in (kinds := _KINDS_OF[self.target]):
            raise ValueError(
                f"`kind` {self.kind!r} does not exist for `target` {self.target!r}, "
                f"which takes {', '.join(sorted(kinds))}"
            )
        if self.end <= self.start_s:
            raise ValueError("`end_s` must be greater than `start_s`")
        if self.low > self.high:
            raise ValueError("`low` must not be greater than `high`")

    @property
    def end(self) -> float:
        """When it ends; infinite for a fault that lasts."""
        return math.inf if self.end_s is None else self.end_s

    def active(self, time_s: float) -> bool:
        """Whether the fault is there at ``time_s``."""
        if not self.start_s <= time_s < self.end:
            return False
        return self.kind != "intermittent" or self._cycles(time_s) % 1.0 < self.duty

    def next_edge(self, time_s: float) -> float:
        """When it next comes or goes after ``time_s``; infinite if it does not."""
        if time_s < self.start_s:
            return self.start_s
        if time_s >= self.end:
            return math.inf
        if self.kind != "intermittent":
            return self.end
        cycle, phase = divmod(self._cycles(time_s), 1.0)
        edge = cycle + (self.duty if phase < self.duty else 1.0)
        return min(self.start_s + edge * self.period_s, self.end)

    def _cycles(self, time_s: float) -> float:
        """Periods since the start; a rounded instant just before an edge counts as on it."""
        return (time_s - self.start_s) / self.period_s + 1e-6


def next_boundary(faults: Iterable[Fault], time_s: float) -> float:
    """When any of ``faults`` next comes or goes after ``time_s``; infinite if none does."""
    return min((fault.next_edge(time_s) for fault in faults), default=math.inf)
