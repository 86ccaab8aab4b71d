"""A signal map that has met its DBC: every bit known, every value in the service's units."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace

from tcs_hil.canbus.codec import SignalSpec
from tcs_hil.canbus.mapping.limit_code import LimitCode
from tcs_hil.canbus.mapping.protection import Protection
from tcs_hil.canbus.mapping.units import Kind
from tcs_hil.signals import Command

MOTOR_INPUTS = (
    "motor_speed_left",
    "motor_speed_right",
    "motor_torque_left",
    "motor_torque_right",
)
DRIVER_INPUTS = ("driver_torque_left", "driver_torque_right")
AXLE_INPUT = "driver_torque_axle"
ACCEL_INPUT = "accel_x"
WHEEL_INPUTS = ("wheel_speed_fl", "wheel_speed_fr", "wheel_speed_rl", "wheel_speed_rr")
KINDS: Mapping[str, Kind] = {
    **dict.fromkeys(WHEEL_INPUTS, Kind.WHEEL_SPEED),
    **dict.fromkeys(MOTOR_INPUTS[:2], Kind.MOTOR_SPEED),
    **dict.fromkeys(MOTOR_INPUTS[2:], Kind.TORQUE),
    **dict.fromkeys((*DRIVER_INPUTS, AXLE_INPUT), Kind.TORQUE),
    ACCEL_INPUT: Kind.ACCELERATION,
}
"""What each input of the map measures."""


@dataclass(frozen=True, slots=True)
class RawRule:
    """Believe a value while the raw value of ``signal`` is (``wanted``), or is not, among these."""

    signal: SignalSpec
    values: frozenset[int]
    wanted: bool

    def holds(self, raw: float) -> bool:
        """Whether the rule lets the value pass."""
        return (raw in self.values) is self.wanted


@dataclass(frozen=True, slots=True)
class RangeRule:
    """Believe a value while the DBC's physical value of ``signal`` lies in a range."""

    signal: SignalSpec
    low: float
    high: float

    def holds(self, value: float) -> bool:
        """Whether the rule lets the value pass."""
        return self.low <= value <= self.high


Rule = RawRule | RangeRule
Page = tuple[RawRule, ...]
"""What the multiplexers of a message must read for a signal to be in the frame."""


@dataclass(frozen=True, slots=True)
class MappedMessage:
    """Frame, cycle and protection of a message; the cycle is 0 where nobody knows it."""

    name: str
    frame_id: int
    length: int
    cycle_ms: float
    protection: Protection | None


@dataclass(frozen=True, slots=True)
class MappedInput:
    """One quantity of a measurement: decoded, ``value`` is in the unit of its kind."""

    message: str
    unit: str
    value: SignalSpec
    page: Page
    rules: tuple[Rule, ...]


@dataclass(frozen=True, slots=True)
class MappedField:
    """One signal of a message that goes out, and how a command fills it."""

    key: str
    message: str
    signal: SignalSpec
    fill: Callable[[Command], float]


@dataclass(frozen=True, slots=True)
class MappedOutput:
    """A message that goes out; bits of no field are zero."""

    message: MappedMessage
    fields: tuple[MappedField, ...]


@dataclass(frozen=True, slots=True)
class Plan:
    """Everything a node needs; ``messages`` are those received, by name.

    ``ceilings`` tells what each ceiling signal can say, by its key in the map.
    """

    inputs: Mapping[str, MappedInput]
    messages: Mapping[str, MappedMessage]
    outputs: tuple[MappedOutput, ...]
    ceilings: Mapping[str, LimitCode]

    def inputs_of(self, message: str) -> dict[str, MappedInput]:
        """Inputs that one message brings."""
        return {name: m for name, m in self.inputs.items() if m.message == message}

    def pages_of(self, message: str) -> int:
        """How many frames of a multiplexed message it takes to bring all its inputs."""
        pages: list[Page] = []
        for mapped in self.inputs_of(message).values():
            if mapped.page not in pages:
                pages.append(mapped.page)
        return len(pages)

    def sources(self, names: Iterable[str]) -> tuple[MappedMessage, ...]:
        """Messages that bring these inputs, as far as both are known, lowest identifier first."""
        wanted = {self.inputs[name].message for name in names if name in self.inputs}
        found = (message for message in self.messages.values() if message.name in wanted)
        return tuple(sorted(found, key=lambda message: message.frame_id))


def raw(signal: SignalSpec) -> SignalSpec:
    """The same bits as a plain number, whatever the DBC says of scale and range."""
    low, high = (-(1 << signal.length - 1), signal.mask >> 1) if signal.signed else (0, signal.mask)
    return replace(signal, scale=1, offset=0, minimum=low, maximum=high, labels={})


def scaled(signal: SignalSpec, gain: float, offset: float) -> SignalSpec:
    """The same bits in another unit: the physical value times ``gain`` plus ``offset``."""
    ends = sorted((signal.minimum * gain + offset, signal.maximum * gain + offset))
    return replace(
        signal,
        scale=signal.scale * gain,
        offset=signal.offset * gain + offset,
        minimum=ends[0],
        maximum=ends[1],
        labels={},
    )
