"""A recording replayed through the service's own loop, as fast as the machine goes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.frame import Frame, PortCounters
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.hil.replay.recorded import Answers, RecordedTick
from tcs_hil.runtime.clock import MonotonicClock
from tcs_hil.runtime.loop import Loop
from tcs_hil.runtime.record import Record
from tcs_hil.runtime.tick import Tick
from tcs_hil.service.settings import ServiceConfig
from tcs_hil.service.wiring import build_laws, build_pipeline
from tcs_hil.signals import BusCondition

FOREVER_NS = 2**63 - 1


class _Tape:
    """What was recorded, tick by tick; ``answers`` are what is said to it instead."""

    def __init__(self, ticks: Sequence[RecordedTick]) -> None:
        self.answers: Answers = []
        self._ticks = ticks

    @property
    def tick(self) -> RecordedTick:
        """The tick that has not been answered yet."""
        return self._ticks[len(self.answers)]

    def ended(self) -> bool:
        """Whether every tick has been answered."""
        return len(self.answers) == len(self._ticks)


class _TapePort:
    """The loop's port: nobody is there to hear, so it keeps what is sent."""

    def __init__(self, tape: _Tape) -> None:
        self.counters = PortCounters()
        self.sent: list[Frame] = []
        self._tape = tape

    def receive(self) -> list[Frame]:
        """What the service heard in this tick."""
        return list(self._tape.tick.inputs)

    def wait(self, _timeout_s: float) -> bool:
        """There is always more until the tape ends."""
        return True

    def send(self, frame_id: int, data: bytes) -> bool:
        """Keep one frame, stamped with the time of its tick."""
        self.sent.append(Frame(frame_id, data, self._tape.tick.now_ns))
        return True

    def condition(self) -> BusCondition:
        """What the bus had shown to the recorded service."""
        return self._tape.tick.bus


class _TapeTrigger:
    """The loop's trigger: ticks when the recorded service did, without waiting for it."""

    def __init__(self, tape: _Tape, port: _TapePort) -> None:
        self._tape = tape
        self._port = port

    def wait(self) -> Tick:
        """The next tick."""
        number, now_ns, *_ = self._tape.tick
        return Tick(number, now_ns, now_ns, now_ns, FOREVER_NS, 0)

    def frames(self, _tick: Tick) -> list[Frame]:
        """What the service heard in this tick."""
        return self._port.receive()

    def done(self, _tick: Tick) -> None:
        """Wind the tape on."""
        sent, self._port.sent = self._port.sent, []
        self._tape.answers.append(tuple(sent))


def replay(ticks: Sequence[RecordedTick], config: ServiceConfig) -> Answers:
    """Let a service that ``config`` describes live through ``ticks``; what it says in each.

    It is fresh at the first of them, as the recorded one was if it was recorded
    from its start on.

    Raises:
        TcsError: DBC or model cannot be used.
    """
    path = config.bus.database
    node = TcsNode(load_database(None if path is None else Path(path)))
    tape, clock = _Tape(ticks), MonotonicClock()
    port = _TapePort(tape)
    laws = build_laws(config, clock)
    loop = Loop(
        trigger=_TapeTrigger(tape, port),
        port=port,
        node=node,
        pipeline=build_pipeline(config, laws),
        laws=laws,
        clock=clock,
        write=_unrecorded,
        healthy=_unwatched,
    )
    loop.run(tape.ended)
    return tape.answers


def _unrecorded(_record: Record) -> None:
    """The answers are all that is compared."""


def _unwatched(_sent_ns: int) -> None:
    """No watchdog guards a replay."""
