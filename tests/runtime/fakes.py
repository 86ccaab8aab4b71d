"""Stand-ins for the operating system, the bus and the control code."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Sequence

from msgspec.structs import replace

from tcs_hil.canbus.inbox import InboxCounters
from tcs_hil.canbus.port import Frame, PortCounters
from tcs_hil.control.protocol import Proposal, WheelState
from tcs_hil.estimator import Estimate
from tcs_hil.fault_codes import FaultCode
from tcs_hil.gate import Permission
from tcs_hil.judgement import Verdict
from tcs_hil.runtime.record import Record, record
from tcs_hil.runtime.recording import RunInfo
from tcs_hil.runtime.tick import Insight, Pass, Stamps, Tick
from tcs_hil.signals import (
    BusCondition,
    Command,
    ControllerKind,
    Measurement,
    Suspect,
    TcsState,
    TorqueLimits,
)
from tcs_hil.trace import Trace

PERIOD_NS = 2_000_000
MEASUREMENT = Measurement(
    wheel_speed_radps=(11.0, 12.0, 13.0, 14.0),
    wheel_speed_valid=(True, True, True, True),
    motor_speed_radps=(31.0, 32.0),
    motor_torque_nm=(41.0, 42.0),
    driver_torque_nm=(51.0, 52.0),
    accel_x_mps2=math.nan,
    front_speed_age_s=0.001,
    rear_speed_age_s=0.002,
    motor_age_s=0.003,
    driver_age_s=math.inf,
    bus=BusCondition.SEND_FAILED,
)
COMMAND = Command(
    limits=TorqueLimits(61.0, math.inf),
    active=(True, False),
    state=TcsState.ACTIVE,
    fault_code=FaultCode.NONE,
    controller=ControllerKind.NMPC,
    slip_ratio=(0.1, 0.2),
    slip_reference=0.1,
)
WHEEL = WheelState(0.5, 12.0, 0.1, 5.0, 31.0, 41.0)
TRACE = Trace(
    Estimate(7.0, (WHEEL, WHEEL)),
    (Proposal(71.0, iterations=3), Proposal(72.0, iterations=4)),
    Verdict(TcsState.ACTIVE, FaultCode.NONE, Permission.FOLLOW),
    Suspect.WHEEL_RL | Suspect.DRIVER,
)


class FakeClock:
    """A clock that moves only when somebody sleeps, or is made to work."""

    def __init__(self, now_ns: int = 0) -> None:
        self.time_ns = now_ns

    def now_ns(self) -> int:
        return self.time_ns

    def sleep_until(self, deadline_ns: int) -> None:
        self.time_ns = max(self.time_ns, deadline_ns)

    def work(self, duration_ns: int) -> None:
        self.time_ns += duration_ns


class FakePort:
    """A bus on which frames arrive when the script says; waiting moves the clock."""

    def __init__(self, clock: FakeClock, script: Iterable[Frame] = ()) -> None:
        self.counters = PortCounters(rx=101, tx=102, error_frames=1, rx_errors=2, tx_errors=3)
        self.sent: list[tuple[int, bytes]] = []
        self.bus = MEASUREMENT.bus
        self._clock = clock
        self._script = deque(script)

    def receive(self) -> list[Frame]:
        frames = []
        while self._script and self._script[0].stamp_ns <= self._clock.now_ns():
            frames.append(self._script.popleft())
        return frames

    def wait(self, timeout_s: float) -> bool:
        give_up_ns = self._clock.now_ns() + round(timeout_s * 1e9)
        arrives = bool(self._script) and self._script[0].stamp_ns <= give_up_ns
        self._clock.sleep_until(self._script[0].stamp_ns if arrives else give_up_ns)
        return arrives

    def condition(self) -> BusCondition:
        return self.bus

    def send(self, frame_id: int, data: bytes) -> bool:
        self.sent.append((frame_id, data))
        return True


class FakeNode:
    """A node that remembers what it was fed and sends one frame a tick."""

    bench_tick: int | None = None

    def __init__(self, wheel_stamp_ns: int | None = None) -> None:
        self.counters = InboxCounters()
        self.newest_wheel_stamp_ns = wheel_stamp_ns
        self.fed: list[Frame] = []
        self.overruns: list[int] = []

    def feed(self, frame_id: int, data: bytes, stamp_ns: int) -> bool:
        self.fed.append(Frame(frame_id, data, stamp_ns))
        return True

    def measurement(self, _now_ns: int, bus: BusCondition) -> Measurement:
        return replace(MEASUREMENT, bus=bus)

    def frames(
        self, _command: Command, _now_ns: int, tick_overruns: int
    ) -> Sequence[tuple[int, bytes]]:
        self.overruns.append(tick_overruns)
        return [(0x90, b"limit")]

    def bench_tick_done(self, tick: int) -> tuple[int, bytes]:
        return 0x7F1, tick.to_bytes(4, "little")


class FakeBench(FakeNode):
    """The node in lockstep: understands four-byte announcements only."""

    def feed(self, frame_id: int, data: bytes, stamp_ns: int) -> bool:
        if len(data) != 4:
            return False
        self.bench_tick = int.from_bytes(data, "little")
        return super().feed(frame_id, data, stamp_ns)


def made_pass(number: int = 0, *, sent_us: int = 90, scheduled_ns: int = PERIOD_NS) -> Pass:
    """A tick that woke 10 µs late, and was received, stepped and sent at 20, 50, ``sent_us``."""
    wake_ns = scheduled_ns + 10_000
    stamps = Stamps(wake_ns + 10_000, wake_ns + 40_000, scheduled_ns + sent_us * 1000)
    tick = Tick(number, scheduled_ns, wake_ns, wake_ns, scheduled_ns + PERIOD_NS, 0)
    overrun = stamps.sent_ns > tick.deadline_ns
    return Pass(tick, stamps, 4, MEASUREMENT, COMMAND, failed=False, overrun=overrun)


def insight(wheel_stamp_ns: int | None = None) -> Insight:
    counters = PortCounters(rx=101, tx=102, error_frames=1, lost=4, rx_errors=2, tx_errors=3)
    inbox = InboxCounters(e2e_error=5, repeated=6, wrong_sequence=7)
    return Insight(TRACE, (81, 82), wheel_stamp_ns, counters, inbox)


RUN = RunInfo(
    period_ns=PERIOD_NS,
    started_monotonic_ns=1,
    started_realtime_ns=2,
    controller="nmpc",
    backend="python",
    bus="virtual:test",
    machine="a test",
)


def numbered(number: int) -> Record:
    return record(made_pass(number), insight())
