"""One namespace over everything a run records: bus signals, flight recorder, plant truth."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Literal

from cantools.database.can import Message, Signal

from plant_emulator.truth import TRUTH_DTYPE
from tcs_hil.canbus.database import parse_dbc
from tcs_hil.errors import ConfigError, offer
from tcs_hil.hil.export.telemetry import ENUMERATIONS
from tcs_hil.names import NO_UNIT, column_names, unit_of
from tcs_hil.runtime.record import FIELDS

Source = Literal["truth", "service", "bus"]

STAGES = {
    "wake_jitter_us": ("scheduled_ns", "wake_ns"),
    "receive_us": ("wake_ns", "received_ns"),
    "decide_us": ("received_ns", "stepped_ns"),
    "send_us": ("stepped_ns", "sent_ns"),
    "tick_us": ("wake_ns", "sent_ns"),
}
"""Times of a tick between two of its stamps."""
LATENCY = "latency_us"
LISTED = "; docs/hil.md says which there are, `tcs-hil signals` those of the bus"
CLOCKED = {
    *STAGES,
    LATENCY,
    *("overrun", "skipped", "latency_ns"),
    *("scheduled_ns", "wake_ns", "received_ns", "stepped_ns", "sent_ns"),
}
"""What means something only where a clock, not the bench, sets the pace."""


@dataclass(frozen=True, slots=True)
class Channel:
    """One signal; ``labels`` name values of it, ``clocked`` says it needs a run in real time."""

    source: Source
    name: str
    unit: str
    labels: Mapping[str, float] = field(default_factory=dict)
    clocked: bool = False

    def __str__(self) -> str:
        """The full name."""
        return f"{self.source}.{self.name}"


class Namespace:
    """Channels by full name, such as ``truth.slip_ratio_fl``, or by a last part that is unique."""

    def __init__(self, channels: Iterator[Channel]) -> None:
        self._by_full = {str(channel): channel for channel in channels}
        self._by_short: dict[str, list[str]] = defaultdict(list)
        for full, channel in self._by_full.items():
            self._by_short[channel.name].append(full)

    def __iter__(self) -> Iterator[Channel]:
        """Every channel: truth, service, bus."""
        return iter(self._by_full.values())

    def find(self, name: str) -> Channel:
        """Look a channel up.

        Raises:
            ConfigError: there is none of that name, or more than one.
        """
        candidates = [name] if name in self._by_full else self._by_short.get(name, [])
        if len(candidates) == 1:
            return self._by_full[candidates[0]]
        if candidates:
            raise ConfigError(f"signal {name!r} may be {' or '.join(candidates)}")
        names = [*self._by_full, *self._by_short]
        raise ConfigError(f"there is no signal {name!r}{offer(name, names) or LISTED}")


def number(value: float | str, labels: Mapping[str, float], what: str) -> float:
    """A value of ``what`` given as a number or by its label.

    Raises:
        ConfigError: there is no such label.
    """
    if isinstance(value, float):
        return value
    if value not in labels:
        known = f"is one of {', '.join(labels)}" if labels else "is a number"
        raise ConfigError(f"{what} {known}, not {value!r}")
    return labels[value]


@lru_cache(maxsize=4)
def namespace(database: str | None) -> Namespace:
    """Every channel of a run on the bus that ``database`` describes; None is the built-in DBC.

    Raises:
        DatabaseError: the DBC cannot be read.
    """
    return Namespace(_channels(database))


@lru_cache(maxsize=4)
def signals(database: str | None) -> dict[str, tuple[Message, Signal]]:
    """Every signal of a DBC by its name, or message and name where several messages have it.

    Raises:
        DatabaseError: the DBC cannot be read.
    """
    messages = parse_dbc(None if database is None else Path(database))[1].messages
    pairs = [(message, signal) for message in messages for signal in message.signals]
    count = Counter(signal.name for _, signal in pairs)
    named: dict[str, tuple[Message, Signal]] = {}
    for message, signal in pairs:
        unique = count[signal.name] == 1
        named[signal.name if unique else f"{message.name}.{signal.name}"] = message, signal
    return named


def _channels(database: str | None) -> Iterator[Channel]:
    yield from _truth_channels()
    for name in (*FIELDS, *STAGES, LATENCY):
        labels = {member.name: float(member) for member in ENUMERATIONS.get(name, ())}
        yield Channel("service", name, _unit(name), labels, name in CLOCKED)
    yield from _bus_channels(database)


def _truth_channels() -> Iterator[Channel]:
    for name in TRUTH_DTYPE.names or ():
        for column in column_names(name, TRUTH_DTYPE[name].shape):
            yield Channel("truth", column, _unit(column))


def _bus_channels(database: str | None) -> Iterator[Channel]:
    for name, (_, signal) in signals(database).items():
        labels = {str(label): float(value) for value, label in (signal.choices or {}).items()}
        yield Channel("bus", name, (signal.unit or "").strip(NO_UNIT), labels)


def _unit(name: str) -> str:
    return unit_of(name).strip(NO_UNIT)
