"""The service as a node on another car's bus.  Pure: time is an argument."""

from __future__ import annotations

import math
from typing import Final

from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.mapping.group import Group
from tcs_hil.canbus.mapping.mailbox import MappedMailbox
from tcs_hil.canbus.mapping.plan import (
    ACCEL_INPUT,
    AXLE_INPUT,
    DRIVER_INPUTS,
    KINDS,
    MOTOR_INPUTS,
    WHEEL_INPUTS,
    Plan,
)
from tcs_hil.canbus.mapping.reading import Reading
from tcs_hil.canbus.mapping.sender import MappedSender
from tcs_hil.canbus.outbox import OutgoingFrame
from tcs_hil.canbus.service_node import ServiceNode
from tcs_hil.signals import BusCondition, Command, Measurement

ACCEL_PATIENCE_CYCLES: Final = 3
"""A measurement does not tell how old the acceleration is: older than this it is none."""


class MappedNode(ServiceNode):
    """Does what ``TcsNode`` does, with the messages of a signal map.

    Wheel speeds nobody vouches for are handed on as such; a torque or a motor's
    speed marked invalid counts as not received, so its age tells.  What the map
    leaves out has never been received.  The two lockstep frames are our own.
    """

    def __init__(self, plan: Plan) -> None:
        readings = {name: Reading(keeps_doubtful=name in WHEEL_INPUTS) for name in KINDS}
        mailboxes = {
            name: MappedMailbox(message, plan.inputs_of(name), readings)
            for name, message in plan.messages.items()
        }

        def group(*names: str) -> Group:
            sources = {plan.inputs[name].message for name in names if name in plan.inputs}
            return Group([readings[name] for name in names], [mailboxes[s] for s in sources])

        self._front = group(*WHEEL_INPUTS[:2])
        self._rear = group(*WHEEL_INPUTS[2:])
        self._motor = group(*MOTOR_INPUTS)
        axle = AXLE_INPUT in plan.inputs
        self._driver = group(*((AXLE_INPUT, AXLE_INPUT) if axle else DRIVER_INPUTS))
        self._accel = readings[ACCEL_INPUT]
        self._accel_patience_s = _accel_patience_s(plan)
        self._senders = tuple(MappedSender(output) for output in plan.outputs)
        own_ids = [output.message.frame_id for output in plan.outputs]
        super().__init__(load_database(), mailboxes.values(), own_ids)

    @property
    def newest_wheel_stamp_ns(self) -> int | None:
        """Stamp of the newest good wheel-speed frame: where the latency starts."""
        return max((*self._front.stamps_ns, *self._rear.stamps_ns), default=None)

    def measurement(self, now_ns: int, bus: BusCondition = BusCondition.OK) -> Measurement:
        """Newest value of every input, its age and state at ``now_ns``, and the bus's condition."""
        fl, fr = self._front.values
        rl, rr = self._rear.values
        fl_valid, fr_valid = self._front.valid
        rl_valid, rr_valid = self._rear.valid
        speed_left, speed_right, torque_left, torque_right = self._motor.values
        driver_left, driver_right = self._driver.values
        return Measurement(
            wheel_speed_radps=(fl, fr, rl, rr),
            wheel_speed_valid=(fl_valid, fr_valid, rl_valid, rr_valid),
            motor_speed_radps=(speed_left, speed_right),
            motor_torque_nm=(torque_left, torque_right),
            driver_torque_nm=(driver_left, driver_right),
            accel_x_mps2=self._accel_x_mps2(now_ns),
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

    def frames(
        self,
        command: Command,
        now_ns: int,
        tick_overruns: int = 0,  # noqa: ARG002 - another car's bus has no word for it
    ) -> list[OutgoingFrame]:
        """Frames of this tick: every message whose cycle is due."""
        return [sender.frame(command) for sender in self._senders if sender.is_due(now_ns)]

    def _accel_x_mps2(self, now_ns: int) -> float:
        fresh = self._accel.valid and self._accel.age_s(now_ns) <= self._accel_patience_s
        return self._accel.value if fresh else math.nan


def _accel_patience_s(plan: Plan) -> float:
    mapped = plan.inputs.get(ACCEL_INPUT)
    if mapped is None:
        return 0.0
    return ACCEL_PATIENCE_CYCLES * plan.messages[mapped.message].cycle_ms * 1e-3
