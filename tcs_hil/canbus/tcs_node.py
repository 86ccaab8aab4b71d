"""The traction control service as a node on the bus.  Pure: time is an argument."""

from __future__ import annotations

import math
from typing import Final

from tcs_hil.canbus.ceiling import ceiling_codes
from tcs_hil.canbus.contract import TCS
from tcs_hil.canbus.database import Database
from tcs_hil.canbus.inbox import WatchedMailbox
from tcs_hil.canbus.outbox import Outbox, OutgoingFrame
from tcs_hil.canbus.service_node import ServiceNode
from tcs_hil.signals import BusCondition, Command, Measurement, RoadEstimate

MS_PER_S: Final = 1e3


class TcsNode(ServiceNode):
    """Turns frames into a measurement and a command into frames.

    Until a message has arrived its speeds and torques are zero, its validity
    flags false and its age infinite.
    """

    def __init__(self, database: Database) -> None:
        messages = database.messages
        self._front = WatchedMailbox(messages["WheelSpeedsFront"], (0.0, 0.0, 0, 0))
        self._rear = WatchedMailbox(messages["WheelSpeedsRear"], (0.0, 0.0, 0, 0, 0.0, 0))
        self._motor = WatchedMailbox(messages["MotorState"], (0.0, 0.0, 0.0, 0.0))
        self._driver = WatchedMailbox(messages["DriverRequest"], (0.0, 0.0))
        mailboxes = (self._front, self._rear, self._motor, self._driver)
        super().__init__(database, mailboxes, database.frame_ids_of(TCS))
        self._limit = Outbox(messages["TorqueLimit"])
        self._status = Outbox(messages["TcsStatus"])
        self._estimates = Outbox(messages["TcsEstimates"])
        self._ceilings = ceiling_codes(messages["TorqueLimit"])

    @property
    def newest_wheel_stamp_ns(self) -> int | None:
        """Stamp of the newest good wheel-speed frame: where the latency starts."""
        front_ns, rear_ns = self._front.stamp_ns, self._rear.stamp_ns
        if front_ns is None or rear_ns is None:
            return rear_ns if front_ns is None else front_ns
        return max(front_ns, rear_ns)

    def measurement(self, now_ns: int, bus: BusCondition = BusCondition.OK) -> Measurement:
        """Newest value of every input, its age and state at ``now_ns``, and the bus's condition.

        The condition is the worse of what the caller saw and of what the frames told.
        """
        fl, fr, fl_valid, fr_valid = self._front.values
        rl, rr, rl_valid, rr_valid, accel, accel_valid = self._rear.values
        motor_left, motor_right, torque_left, torque_right = self._motor.values
        driver_left, driver_right = self._driver.values
        return Measurement(
            wheel_speed_radps=(fl, fr, rl, rr),
            wheel_speed_valid=(bool(fl_valid), bool(fr_valid), bool(rl_valid), bool(rr_valid)),
            motor_speed_radps=(motor_left, motor_right),
            motor_torque_nm=(torque_left, torque_right),
            driver_torque_nm=(driver_left, driver_right),
            accel_x_mps2=accel if accel_valid else math.nan,
            front_speed_age_s=self._front.age_s(now_ns),
            rear_speed_age_s=self._rear.age_s(now_ns),
            motor_age_s=self._motor.age_s(now_ns),
            driver_age_s=self._driver.age_s(now_ns),
            front_speed_state=self._front.state(now_ns),
            rear_speed_state=self._rear.state(now_ns),
            motor_state=self._motor.state(now_ns),
            driver_state=self._driver.state(now_ns),
            bus=max(bus, self._intrusion()),
        )

    def frames(self, command: Command, now_ns: int, tick_overruns: int = 0) -> list[OutgoingFrame]:
        """Frames of this tick: status or estimates when their cycle is due, the limits last.

        The limits go out with every call, so the call is the cycle.  Status and
        estimates never share a tick with each other.
        """
        frames = []
        if self._status.is_due(now_ns):
            frames.append(self._status_frame(command, tick_overruns))
        elif self._estimates.is_due(now_ns):
            frames.append(self._estimates_frame(command.road))
        frames.append(self._limit_frame(command))
        return frames

    def _limit_frame(self, command: Command) -> OutgoingFrame:
        left, right = self._ceilings
        return self._limit.frame(
            left.to_bus(command.limits.left_nm),
            right.to_bus(command.limits.right_nm),
            *command.active,
            command.state,
        )

    def _status_frame(self, command: Command, tick_overruns: int) -> OutgoingFrame:
        return self._status.frame(
            *command.slip_ratio,
            command.slip_reference,
            command.controller,
            command.fault_code,
            tick_overruns,
        )

    def _estimates_frame(self, road: RoadEstimate) -> OutgoingFrame:
        return self._estimates.frame(
            *road.friction_ratio, *road.confidence_ratio, road.loop_delay_s * MS_PER_S
        )
