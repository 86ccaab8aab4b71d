"""The tick with everything around it faked."""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Sequence

import pytest
from msgspec.structs import replace
from runtime.fakes import (
    COMMAND,
    MEASUREMENT,
    PERIOD_NS,
    TRACE,
    WHEEL,
    FakeClock,
    FakeNode,
    FakePort,
)

from tcs_hil.canbus.port import Frame
from tcs_hil.control.protocol import Proposal, WheelState
from tcs_hil.runtime.loop import Loop
from tcs_hil.runtime.record import FIELDS, Record
from tcs_hil.runtime.stopwatch import TimedController
from tcs_hil.runtime.tick import Tick
from tcs_hil.signals import BusCondition, Command, Measurement, TcsState
from tcs_hil.trace import Trace

ABANDONED = replace(COMMAND, state=TcsState.FAULT)


class ScriptedTrigger:
    """Hands out the ticks of a list (None: nothing happened) and remembers the answers."""

    def __init__(self, clock: FakeClock, ticks: Sequence[Tick | None], inputs: list[Frame]) -> None:
        self.answered: list[int] = []
        self._clock = clock
        self._ticks = deque(ticks)
        self._inputs = inputs

    def exhausted(self) -> bool:
        return not self._ticks

    def wait(self) -> Tick | None:
        tick = self._ticks.popleft()
        if tick is not None:
            self._clock.sleep_until(tick.wake_ns)
        return tick

    def frames(self, _tick: Tick) -> Sequence[Frame]:
        return self._inputs

    def done(self, tick: Tick) -> None:
        self.answered.append(tick.number)


class Law:
    """A control law that takes its time."""

    def __init__(self, clock: FakeClock, takes_ns: int) -> None:
        self.resets = 0
        self._clock = clock
        self._takes_ns = takes_ns

    def step(self, _wheel: WheelState, torque_ref_nm: float) -> Proposal:
        self._clock.work(self._takes_ns)
        return Proposal(torque_ref_nm)

    def reset(self) -> None:
        self.resets += 1


class FakePipeline:
    """Asks both laws, and breaks in the ticks it is told to."""

    def __init__(self, laws: tuple[TimedController, TimedController], breaks_in: set[int]) -> None:
        self.trace: Trace | None = TRACE
        self.abandoned: list[Measurement] = []
        self.overran: list[bool] = []
        self._laws = laws
        self._breaks_in = breaks_in
        self._steps = -1

    def step(self, _measurement: Measurement) -> Command:
        self._steps += 1
        if self._steps in self._breaks_in:
            raise ZeroDivisionError("a bug")
        for law in self._laws:
            law.step(WHEEL, 100.0)
        return COMMAND

    def sent(self, overran: bool) -> None:
        self.overran.append(overran)

    def abandon(self, measurement: Measurement) -> Command:
        self.abandoned.append(measurement)
        return ABANDONED


class Rig:
    """A loop over ``ticks`` ticks whose left law takes 30 µs and whose right law 40 µs."""

    def __init__(
        self, ticks: int = 1, *, left_ns: int = 30_000, breaks_in: Sequence[int] = ()
    ) -> None:
        self.clock = FakeClock()
        self.records: list[Record] = []
        self.fed_watchdog_at: list[int] = []
        self.node = FakeNode(wheel_stamp_ns=PERIOD_NS - 100_000)
        self.port = FakePort(self.clock)
        laws = (
            TimedController(Law(self.clock, left_ns), self.clock),
            TimedController(Law(self.clock, 40_000), self.clock),
        )
        self.pipeline = FakePipeline(laws, set(breaks_in))
        self.trigger = ScriptedTrigger(
            self.clock, [tick(n) for n in range(ticks)], [Frame(0xA2, b"rear", 7)]
        )
        self.loop = Loop(
            self.trigger,
            self.port,
            self.node,
            self.pipeline,
            laws,
            self.clock,
            self.records.append,
            self.fed_watchdog_at.append,
        )

    def run(self) -> None:
        self.loop.run(self.trigger.exhausted)

    def recorded(self, field: str) -> list[float]:
        return [record[list(FIELDS).index(field)] for record in self.records]


def tick(number: int) -> Tick:
    scheduled_ns = (number + 1) * PERIOD_NS
    wake_ns = scheduled_ns + 10_000
    return Tick(number, scheduled_ns, wake_ns, wake_ns, scheduled_ns + PERIOD_NS, 0)


def test_a_tick_drains_decides_and_sends() -> None:
    rig = Rig()
    rig.run()
    assert rig.node.fed == [Frame(0xA2, b"rear", 7)]
    assert rig.port.sent == [(0x90, b"limit")]
    assert rig.trigger.answered == [0]
    assert rig.recorded("limit_fl_nm") == [COMMAND.limits.left_nm]


def test_what_the_bus_has_shown_is_put_before_the_pipeline_and_on_record() -> None:
    rig = Rig(breaks_in=[0])
    rig.port.bus = BusCondition.BUS_OFF
    rig.run()
    assert rig.pipeline.abandoned[0].bus is BusCondition.BUS_OFF
    assert rig.recorded("bus_condition") == [BusCondition.BUS_OFF]


def test_the_stages_are_stamped_in_order() -> None:
    rig = Rig()
    rig.run()
    received, stepped, sent = (rig.recorded(f"{s}_ns")[0] for s in ("received", "stepped", "sent"))
    assert received == PERIOD_NS + 10_000
    assert stepped - received == 70_000
    assert sent == stepped


def test_each_law_is_timed_by_itself() -> None:
    rig = Rig(2)
    rig.run()
    assert rig.recorded("solve_fl_ns") == [30_000, 30_000]
    assert rig.recorded("solve_fr_ns") == [40_000, 40_000]


def test_latency_runs_from_the_wheel_speed_frame_to_the_end_of_sending() -> None:
    rig = Rig()
    rig.run()
    assert rig.recorded("latency_ns") == [100_000 + 10_000 + 70_000]


def test_a_tick_in_time_is_healthy() -> None:
    rig = Rig(3)
    rig.run()
    assert len(rig.fed_watchdog_at) == 3
    assert rig.recorded("overrun") == [False] * 3
    assert rig.pipeline.overran == [False] * 3


def test_an_overrun_is_counted_published_with_the_next_tick_and_not_healthy() -> None:
    rig = Rig(2, left_ns=PERIOD_NS)
    rig.run()
    assert rig.loop.overruns == 2
    assert rig.node.overruns == [0, 1]
    assert rig.recorded("overrun") == [True, True]
    assert rig.pipeline.overran == [True, True]
    assert rig.fed_watchdog_at == []


def test_a_step_that_raises_gives_the_torque_back_and_the_service_goes_on() -> None:
    rig = Rig(3, breaks_in=[1])
    rig.run()
    assert rig.pipeline.abandoned == [MEASUREMENT]
    assert rig.recorded("state") == [TcsState.ACTIVE, TcsState.FAULT, TcsState.ACTIVE]
    assert rig.recorded("failed") == [False, True, False]
    assert len(rig.port.sent) == 3
    assert len(rig.fed_watchdog_at) == 2
    assert rig.trigger.answered == [0, 1, 2]


def test_a_law_that_was_not_asked_took_no_time() -> None:
    rig = Rig(2, breaks_in=[1])
    rig.run()
    assert rig.recorded("solve_fl_ns") == [30_000, 0]


def test_failures_are_logged_once_with_their_cause(caplog: pytest.LogCaptureFixture) -> None:
    rig = Rig(5, breaks_in=range(5))
    with caplog.at_level(logging.ERROR):
        rig.run()
    assert rig.loop.failures == 5
    (failure,) = [r for r in caplog.records if r.name == "tcs_hil.runtime.loop"]
    assert failure.exc_text is not None
    assert "a bug" in failure.exc_text


def test_a_change_of_state_is_logged(caplog: pytest.LogCaptureFixture) -> None:
    rig = Rig(3, breaks_in=[1])
    with caplog.at_level(logging.WARNING, "tcs_hil.runtime.transitions"):
        rig.run()
    lines = [r.message for r in caplog.records if r.name == "tcs_hil.runtime.transitions"]
    assert [line.partition(" code")[0] for line in lines] == [
        "state=FAULT before=STANDBY",
        "state=STANDBY before=FAULT",
    ]


def test_a_trigger_without_a_tick_sends_nothing() -> None:
    rig = Rig()
    rig.trigger = ScriptedTrigger(rig.clock, [None, None], [])
    rig.loop.trigger = rig.trigger
    rig.run()
    assert rig.port.sent == []
    assert rig.records == []


def test_a_stop_request_before_the_first_tick_makes_none() -> None:
    rig = Rig()
    rig.loop.run(lambda: True)
    assert rig.port.sent == []


def test_timing_a_law_changes_nothing_else() -> None:
    clock = FakeClock()
    law = Law(clock, 5)
    timed = TimedController(law, clock)
    assert timed.step(WHEEL, 12.0) == Proposal(12.0)
    assert timed.step(WHEEL, 13.0) == Proposal(13.0)
    timed.reset()
    assert law.resets == 1
    assert (timed.lap_ns(), timed.lap_ns()) == (10, 0)
