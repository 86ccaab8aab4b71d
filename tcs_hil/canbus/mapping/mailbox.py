"""Receiving one message of another car: protection, multiplexers, values, validity."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple

from tcs_hil.canbus.codec import SignalSpec, compile_codec
from tcs_hil.canbus.e2e import ERROR, OK, E2EStatus
from tcs_hil.canbus.e2e_state import Threshold, WindowSpec
from tcs_hil.canbus.mapping.plan import MappedInput, MappedMessage, Rule
from tcs_hil.canbus.mapping.reading import Reading
from tcs_hil.canbus.watch import MessageWatch
from tcs_hil.signals import InputState

NS_PER_MS = 1_000_000
FAST_WINDOW = WindowSpec(10, Threshold(5, 2), Threshold(5, 4), Threshold(6, 2))
SLOW_WINDOW = WindowSpec(6, Threshold(2, 1), Threshold(2, 2), Threshold(2, 1))
SLOW_CYCLE_MS = 10.0
"""From here on a window of ten would take too long to fill; our own DBC has the same two."""

Test = tuple[int, Callable[[float], bool]]
"""Place of a value among those decoded, and whether it is as it should be."""


class _Target(NamedTuple):
    reading: Reading
    place: int
    page: tuple[Test, ...]
    rules: tuple[Test, ...]


class MappedMailbox:
    """Sorts the values of one message into the readings of the quantities mapped to it."""

    def __init__(
        self,
        message: MappedMessage,
        inputs: Mapping[str, MappedInput],
        readings: Mapping[str, Reading],
    ) -> None:
        self.frame_id = message.frame_id
        self.length = message.length
        signals = _signals(inputs.values())
        self._decode = compile_codec(message.name, message.length, signals).decode
        self._targets = tuple(
            _target(readings[name], mapped, signals) for name, mapped in inputs.items()
        )
        self._checker = message.protection.checker() if message.protection is not None else None
        window = SLOW_WINDOW if message.cycle_ms >= SLOW_CYCLE_MS else FAST_WINDOW
        self._watch = MessageWatch(window, round(message.cycle_ms * NS_PER_MS))

    def put(self, data: bytes, stamp_ns: int) -> E2EStatus:
        """Judge a frame of the right length and keep its values when they are good."""
        status = self._checker.check(data) if self._checker is not None else OK
        self._watch.count(status, stamp_ns)
        if status is OK:
            self._take(self._decode(data), stamp_ns)
        return status

    def reject(self, stamp_ns: int) -> None:
        """Count a frame of the wrong length as an error."""
        self._watch.count(ERROR, stamp_ns)

    def state(self, now_ns: int) -> InputState:
        """What the protection has come to by ``now_ns``."""
        return self._watch.state(now_ns)

    def _take(self, values: tuple[float, ...], stamp_ns: int) -> None:
        for reading, place, page, rules in self._targets:
            if _hold(page, values):
                reading.take(values[place], _hold(rules, values), stamp_ns)


def _hold(tests: tuple[Test, ...], values: tuple[float, ...]) -> bool:
    for place, holds in tests:  # noqa: SIM110 - all() would cost half a frame more
        if not holds(values[place]):
            return False
    return True


def _signals(inputs: Iterable[MappedInput]) -> list[SignalSpec]:
    """Everything to be decoded, each once: flags and multiplexers serve several inputs."""
    signals: list[SignalSpec] = []
    for mapped in inputs:
        rules = (rule.signal for rule in (*mapped.page, *mapped.rules))
        signals += [signal for signal in (mapped.value, *rules) if signal not in signals]
    return signals


def _target(reading: Reading, mapped: MappedInput, signals: list[SignalSpec]) -> _Target:
    def tests(rules: Iterable[Rule]) -> tuple[Test, ...]:
        return tuple((signals.index(rule.signal), rule.holds) for rule in rules)

    return _Target(reading, signals.index(mapped.value), tests(mapped.page), tests(mapped.rules))
