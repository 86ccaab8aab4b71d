"""What a replayed service said beside what the recorded one had said, tick by tick."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from tcs_hil.canbus.codec import SignalSpec
from tcs_hil.canbus.contract import NO_LIMIT_LABEL
from tcs_hil.canbus.database import Database
from tcs_hil.canbus.frame import Frame
from tcs_hil.hil.replay.recorded import Answers, RecordedTick

Signals = Mapping[str, Sequence[str]]
"""Names of signals to compare, by their message."""

TORQUES = ("TorqueLimitL", "TorqueLimitR")
LIMITS: Signals = {"TorqueLimit": (*TORQUES, "TcsActiveL", "TcsActiveR", "TcsState")}
LAW = "TcsController"
DECISIONS: Signals = {**LIMITS, "TcsStatus": (LAW, "TcsFaultCode")}
"""Everything the service decides; what it only displays depends on the machine's speed."""
OTHER_LAW: Signals = {**LIMITS, "TcsStatus": ("TcsFaultCode",)}
"""What may agree where another law is in charge: its name cannot."""

ROUNDING_NM = 1e-9
"""Of physical values made of raw ones that are exactly as far apart as allowed."""

Values = dict[str, float]


@dataclass(frozen=True, slots=True)
class Difference:
    """A signal, recorded and replayed, in the tick at ``place`` of the recording.

    ``replayed`` is NaN where the replayed service had not said anything yet; no
    torque limit is an infinite one.
    """

    place: int
    signal: SignalSpec
    recorded: float
    replayed: float

    @property
    def torque_nm(self) -> float:
        """How far apart two torque limits are; finite for nothing else."""
        apart_nm = abs(self.replayed - self.recorded)
        return apart_nm if self.signal.name in TORQUES else math.inf


@dataclass(frozen=True, slots=True)
class Comparison:
    """How many ticks were compared and differ; what differs in the first one that does.

    ``largest_nm`` is between any two torque limits, allowed or not; None where
    never both had one.
    """

    ticks: int
    differing: int
    largest_nm: float | None
    first: tuple[Difference, ...]

    @property
    def same(self) -> bool:
        """Whether nothing differs by more than was allowed."""
        return not self.first


def compare(
    ticks: Iterable[RecordedTick],
    replayed: Answers,
    database: Database,
    signals: Signals,
    tolerance_nm: float,
) -> Comparison:
    """Compare ``signals`` wherever the recording holds them; torques may differ by the tolerance.

    Ticks of which the recording holds no answer are not compared.
    """
    decoder = _Decoder(database, signals)
    recorded = [decoder.values(tick.answers) for tick in ticks]
    allowed_nm, largest_nm = tolerance_nm + ROUNDING_NM, None
    beyond: list[Difference] = []
    for each in _pairs(recorded, replayed, decoder):
        if math.isfinite(each.torque_nm):
            largest_nm = max(largest_nm or 0.0, each.torque_nm)
        if each.recorded != each.replayed and not each.torque_nm <= allowed_nm:
            beyond.append(each)
    return Comparison(
        ticks=sum(map(bool, recorded)),
        differing=len({each.place for each in beyond}),
        largest_nm=largest_nm,
        first=tuple(each for each in beyond if each.place == beyond[0].place),
    )


def recorded_law(ticks: Iterable[RecordedTick], database: Database) -> str | None:
    """The controller that the recorded service named first; None if it never did."""
    decoder = _Decoder(database, {"TcsStatus": (LAW,)})
    named = (decoder.values(tick.answers).get(LAW) for tick in ticks)
    law = next((value for value in named if value is not None), None)
    return None if law is None else shown(decoder.signals[LAW], law)


def shown(signal: SignalSpec, value: float) -> str:
    """A compared value in words."""
    if math.isnan(value):
        return "never said"
    if math.isinf(value):
        return NO_LIMIT_LABEL
    labels = {physical: label for label, physical in signal.labels.items()}
    return labels.get(value, f"{value:g}")


class _Decoder:
    """Reads the compared signals out of a tick's answers."""

    def __init__(self, database: Database, signals: Signals) -> None:
        self._specs = {
            database.messages[name].frame_id: database.messages[name] for name in signals
        }
        self.signals = {
            name: database.messages[message].signal(name)
            for message, names in signals.items()
            for name in names
        }

    def values(self, answers: Iterable[Frame]) -> Values:
        """Newest physical value of each compared signal that is there; infinite for no limit."""
        values: Values = {}
        for frame in answers:
            spec = self._specs.get(frame.frame_id)
            if spec is not None and len(frame.data) == spec.length:
                names = (signal.name for signal in spec.signals)
                values |= zip(names, spec.codec.decode(frame.data), strict=True)
        return {
            name: math.inf if signal.labels.get(NO_LIMIT_LABEL) == values[name] else values[name]
            for name, signal in self.signals.items()
            if name in values
        }


def _pairs(
    recorded: Iterable[Values], replayed: Answers, decoder: _Decoder
) -> Iterator[Difference]:
    newest: Values = {}
    for place, (values, answers) in enumerate(zip(recorded, replayed, strict=True)):
        newest |= decoder.values(answers)
        for name, value in values.items():
            yield Difference(place, decoder.signals[name], value, newest.get(name, math.nan))
