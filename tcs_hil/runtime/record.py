"""What one tick leaves in the flight recorder: the fields, and where they come from."""

from __future__ import annotations

import struct
from typing import Final

from tcs_hil.runtime.recording import FieldCode
from tcs_hil.runtime.tick import Insight, Pass

NO_LATENCY: Final = -1

FIELDS: Final = {
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

PACKER: Final = struct.Struct("<" + "".join(FIELDS.values()))
_NUMPY_CODES: dict[str, FieldCode] = {"q": "<i8", "d": "<f8", "B": "|u1", "?": "|b1"}
LAYOUT: Final = [(name, _NUMPY_CODES[code]) for name, code in FIELDS.items()]

Record = tuple[float, ...]


def record(made: Pass, insight: Insight) -> Record:
    """Return the values in the order of ``FIELDS``; every one of them packs."""
    tick, stamps = made.tick, made.stamps
    m, command, trace = made.measurement, made.command, insight.trace
    left, right = trace.proposals
    counters, inbox = insight.counters, insight.inbox
    # Unpacked by hand: compiled, a display of starred values is a list made into a tuple.
    solve_left_ns, solve_right_ns = insight.solve_ns
    fl_radps, fr_radps, rl_radps, rr_radps = m.wheel_speed_radps
    slip_left, slip_right = command.slip_ratio
    driver_left_nm, driver_right_nm = m.driver_torque_nm
    motor_left_nm, motor_right_nm = m.motor_torque_nm
    motor_left_radps, motor_right_radps = m.motor_speed_radps
    return (
        tick.number,
        tick.scheduled_ns,
        tick.wake_ns,
        stamps.received_ns,
        stamps.stepped_ns,
        stamps.sent_ns,
        tick.now_ns,
        insight.wheel_stamp_ns or 0,
        latency_ns(made, insight.wheel_stamp_ns),
        solve_left_ns,
        solve_right_ns,
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
        trace.estimate.vehicle_speed_mps,
        fl_radps,
        fr_radps,
        rl_radps,
        rr_radps,
        slip_left,
        slip_right,
        driver_left_nm,
        driver_right_nm,
        motor_left_nm,
        motor_right_nm,
        motor_left_radps,
        motor_right_radps,
        left.torque_nm,
        right.torque_nm,
        command.limits.left_nm,
        command.limits.right_nm,
        left.status,
        right.status,
        command.state,
        command.fault_code,
        command.controller,
        m.bus,
        trace.suspects,
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
