"""What one tick leaves in the flight recorder: the fields, and where they come from."""

from __future__ import annotations

import struct
from typing import NamedTuple

from tcs_hil.canbus.inbox import InboxCounters
from tcs_hil.canbus.port import PortCounters
from tcs_hil.pipeline import Trace
from tcs_hil.runtime.recording import FieldCode
from tcs_hil.runtime.trigger import Tick
from tcs_hil.signals import Command, Measurement

NO_LATENCY = -1

FIELDS = {
    "number": "q",  # periods since the start, or the bench's tick number
    "scheduled_ns": "q",
    "wake_ns": "q",
    "received_ns": "q",
    "stepped_ns": "q",
    "sent_ns": "q",
    "now_ns": "q",  # the time decisions were made with
    "wheel_stamp_ns": "q",  # newest wheel-speed frame, on the clock of now_ns
    "latency_ns": "q",  # that frame's arrival to our frames sent; NO_LATENCY before the first
    "solve_fl_ns": "q",
    "solve_fr_ns": "q",
    "skipped": "q",  # grid points passed over since the tick before
    "frames": "q",  # received for this tick
    "rx_frames": "q",  # this counter and those below count since the start
    "tx_frames": "q",
    "bus_errors": "q",
    "lost_frames": "q",  # the kernel had no room for them
    "e2e_errors": "q",  # checksum or data id
    "e2e_repeated": "q",
    "e2e_wrong_sequence": "q",
    "iterations_fl": "q",
    "iterations_fr": "q",
    "front_speed_age_s": "d",  # ages at now_ns; inf before the first good frame
    "rear_speed_age_s": "d",
    "motor_age_s": "d",
    "driver_age_s": "d",
    "vehicle_speed_mps": "d",
    "wheel_speed_fl_radps": "d",
    "wheel_speed_fr_radps": "d",
    "wheel_speed_rl_radps": "d",
    "wheel_speed_rr_radps": "d",
    "slip_ratio_fl": "d",
    "slip_ratio_fr": "d",
    "driver_torque_fl_nm": "d",
    "driver_torque_fr_nm": "d",
    "motor_torque_fl_nm": "d",
    "motor_torque_fr_nm": "d",
    "motor_speed_fl_radps": "d",
    "motor_speed_fr_radps": "d",
    "proposal_fl_nm": "d",  # NaN where the controllers were not asked
    "proposal_fr_nm": "d",
    "limit_fl_nm": "d",  # inf is no limit
    "limit_fr_nm": "d",
    "status_fl": "B",
    "status_fr": "B",
    "state": "B",
    "fault_code": "B",
    "controller": "B",
    "bus_condition": "B",  # worst that the bus itself had shown
    "suspects": "B",  # bits of Suspect: inputs that could not be true
    "overrun": "?",  # sent after the deadline
    "failed": "?",  # the pipeline raised
}
"""Name and ``struct`` code of every value; 64 bits where a value could overflow a narrower one."""

PACKER = struct.Struct("<" + "".join(FIELDS.values()))
_NUMPY_CODES: dict[str, FieldCode] = {"q": "<i8", "d": "<f8", "B": "|u1", "?": "|b1"}
LAYOUT = [(name, _NUMPY_CODES[code]) for name, code in FIELDS.items()]

Record = tuple[float, ...]


class Stamps(NamedTuple):
    """When each stage of a tick was finished, CLOCK_MONOTONIC."""

    received_ns: int
    stepped_ns: int
    sent_ns: int


class Pass(NamedTuple):
    """One tick, made."""

    tick: Tick
    stamps: Stamps
    frames: int
    measurement: Measurement
    command: Command
    failed: bool

    @property
    def overrun(self) -> bool:
        """Whether the slack was negative."""
        return self.stamps.sent_ns > self.tick.deadline_ns


class Insight(NamedTuple):
    """What the parts of the service know about the tick just made."""

    trace: Trace
    solve_ns: tuple[int, int]
    wheel_stamp_ns: int | None
    counters: PortCounters
    inbox: InboxCounters


def record(made: Pass, insight: Insight) -> Record:
    """Return the values in the order of ``FIELDS``; every one of them packs."""
    tick, m, command = made.tick, made.measurement, made.command
    left, right = insight.trace.proposals
    counters, inbox = insight.counters, insight.inbox
    return (
        tick.number,
        tick.scheduled_ns,
        tick.wake_ns,
        *made.stamps,
        tick.now_ns,
        insight.wheel_stamp_ns or 0,
        latency_ns(made, insight.wheel_stamp_ns),
        *insight.solve_ns,
        tick.skipped,
        made.frames,
        counters.rx,
        counters.tx,
        counters.error_frames + counters.rx_errors + counters.tx_errors,
        counters.lost,
        inbox.e2e_error,
        inbox.repeated,
        inbox.wrong_sequence,
        left.iterations,
        right.iterations,
        m.front_speed_age_s,
        m.rear_speed_age_s,
        m.motor_age_s,
        m.driver_age_s,
        insight.trace.estimate.vehicle_speed_mps,
        *m.wheel_speed_radps,
        *command.slip_ratio,
        *m.driver_torque_nm,
        *m.motor_torque_nm,
        *m.motor_speed_radps,
        left.torque_nm,
        right.torque_nm,
        *command.limits,
        left.status,
        right.status,
        command.state,
        command.fault_code,
        command.controller,
        m.bus,
        insight.trace.suspects,
        made.overrun,
        made.failed,
    )


def latency_ns(made: Pass, wheel_stamp_ns: int | None) -> int:
    """Receive time of the newest wheel-speed frame to send; ``NO_LATENCY`` without a frame.

    Added up from two clocks, because in lockstep ``now_ns`` and the stamp are
    the bench's.
    """
    if wheel_stamp_ns is None:
        return NO_LATENCY
    tick = made.tick
    return tick.now_ns - wheel_stamp_ns + made.stamps.sent_ns - tick.wake_ns
