"""Replaying onto a bus, with a scripted one."""

from collections import deque
from collections.abc import Sequence

import pytest

from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.frame import Frame, PortCounters
from tcs_hil.errors import BusError
from tcs_hil.hil.replay.live import LEAD_NS, replay_in_lockstep, replay_in_real_time
from tcs_hil.hil.replay.recorded import RecordedTick
from tcs_hil.signals import BusCondition

DATABASE = load_database()
REAR, LIMIT, TICK, DONE = 0x0A2, 0x090, 0x7F0, 0x7F1
PERIOD_NS, ANSWER_NS = 2_000_000, 700_000
START_NS = 77_123_456


class Clock:
    def __init__(self) -> None:
        self.ns = START_NS

    def now_ns(self) -> int:
        return self.ns

    def sleep_until(self, deadline_ns: int) -> None:
        self.ns = max(self.ns, deadline_ns)


class Service:
    """A port with a service behind it that answers what it is sent, in time."""

    def __init__(self, clock: Clock, answers: dict[int, Sequence[int]]) -> None:
        self.counters = PortCounters()
        self.sent: list[tuple[int, int]] = []
        self._clock = clock
        self._answers = answers
        self._waiting: deque[Frame] = deque()

    def send(self, frame_id: int, data: bytes) -> bool:
        now_ns = self._clock.now_ns()
        self.sent.append((frame_id, now_ns))
        for answer in self._answers.get(frame_id, ()):
            self._waiting.append(Frame(answer, data, now_ns + ANSWER_NS))
        return True

    def wait(self, timeout_s: float) -> bool:
        self._clock.ns += round(timeout_s * 1e9)
        return bool(self._waiting)

    def receive(self) -> list[Frame]:
        come = [each for each in self._waiting if each.stamp_ns <= self._clock.now_ns()]
        self._waiting = deque(each for each in self._waiting if each not in come)
        return come

    def condition(self) -> BusCondition:
        return BusCondition.OK


def bench_tick(number: int) -> RecordedTick:
    data = number.to_bytes(4, "little")
    inputs = (Frame(REAR, bytes(8), 0), Frame(TICK, data, 0))
    return RecordedTick(number, number * PERIOD_NS, inputs, ())


def timed_tick(number: int) -> RecordedTick:
    at_ns = 5_000_000_000 + number * PERIOD_NS
    return RecordedTick(number, at_ns + 500_000, (Frame(REAR, bytes(8), at_ns),), ())


def test_in_lockstep_each_tick_waits_for_its_answer() -> None:
    service = Service(clock := Clock(), {TICK: (LIMIT, DONE)})
    answers = replay_in_lockstep([bench_tick(4), bench_tick(5)], service, clock, DATABASE)
    assert [[frame.frame_id for frame in tick] for tick in answers] == [[LIMIT, DONE]] * 2
    assert [frame_id for frame_id, _ in service.sent] == [REAR, TICK, REAR, TICK]


@pytest.mark.parametrize("answers", [{}, {TICK: (LIMIT,)}])
def test_a_service_that_does_not_keep_step_is_given_up_on(
    answers: dict[int, Sequence[int]],
) -> None:
    service = Service(clock := Clock(), answers)
    with pytest.raises(
        BusError, match="no answer to tick 4; start `tcs-hil run --trigger lockstep"
    ):
        replay_in_lockstep([bench_tick(4)], service, clock, DATABASE)


def test_in_real_time_frames_keep_their_distances_and_their_phase() -> None:
    service = Service(clock := Clock(), {REAR: (LIMIT,)})
    ticks = [timed_tick(number) for number in (0, 1, 5)]
    answers = replay_in_real_time(ticks, service, clock, DATABASE, PERIOD_NS)
    sent_ns = [at_ns for _, at_ns in service.sent]
    assert sent_ns[0] >= START_NS + LEAD_NS
    assert sent_ns[0] % PERIOD_NS == 0  # as it was recorded
    assert [at_ns - sent_ns[0] for at_ns in sent_ns] == [0, PERIOD_NS, 5 * PERIOD_NS]
    assert [[frame.frame_id for frame in tick] for tick in answers] == [[LIMIT]] * 3


def test_in_real_time_a_silent_service_is_an_error() -> None:
    with pytest.raises(BusError, match="no answer; start `tcs-hil run`"):
        replay_in_real_time(
            [timed_tick(0)], Service(clock := Clock(), {}), clock, DATABASE, PERIOD_NS
        )
