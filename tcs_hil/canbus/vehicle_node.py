"""The vehicle (or its emulator) as a node on the bus.  Pure: time is an argument."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

from tcs_hil.canbus.ceiling import ceiling_codes
from tcs_hil.canbus.contract import VEHICLE
from tcs_hil.canbus.database import Database
from tcs_hil.canbus.inbox import Inbox, InboxCounters, Mailbox
from tcs_hil.canbus.outbox import Outbox, OutgoingFrame
from tcs_hil.signals import ControllerKind, FourWheels, Pair, RoadEstimate, TcsState, TorqueLimits


class VehicleSignals(NamedTuple):
    """What the sensors and the driver put on the bus; the mirror of ``Measurement``.

    ``accel_x_mps2`` is None where no accelerometer is fitted or it is invalid.
    """

    wheel_speed_radps: FourWheels
    wheel_speed_valid: tuple[bool, bool, bool, bool]
    motor_speed_radps: Pair
    motor_torque_nm: Pair
    driver_torque_nm: Pair
    accel_x_mps2: float | None = None


@dataclass(frozen=True, slots=True)
class ServiceStatus:
    """What the service says about itself, for display and logging."""

    state: TcsState
    active: tuple[bool, bool]
    slip_ratio: Pair
    slip_reference: float
    controller: ControllerKind
    fault_code: int
    tick_overruns: int


_Values: TypeAlias = tuple[float, ...]


def _driver_request(signals: VehicleSignals) -> _Values:
    return signals.driver_torque_nm


def _motor_state(signals: VehicleSignals) -> _Values:
    return *signals.motor_speed_radps, *signals.motor_torque_nm


def _wheel_speeds_front(signals: VehicleSignals) -> _Values:
    return *signals.wheel_speed_radps[:2], *signals.wheel_speed_valid[:2]


def _wheel_speeds_rear(signals: VehicleSignals) -> _Values:
    accel = signals.accel_x_mps2
    return (
        *signals.wheel_speed_radps[2:],
        *signals.wheel_speed_valid[2:],
        0.0 if accel is None else accel,
        accel is not None,
    )


_VALUES: dict[str, Callable[[VehicleSignals], _Values]] = {
    "DriverRequest": _driver_request,
    "MotorState": _motor_state,
    "WheelSpeedsFront": _wheel_speeds_front,
    "WheelSpeedsRear": _wheel_speeds_rear,
}

_STATES = {int(state): state for state in TcsState}
_CONTROLLERS = {int(kind): kind for kind in ControllerKind}


class VehicleNode:
    """Turns the vehicle's signals into frames and frames into torque limits.

    Until the first good frame the limits are "no limit" and their stamp is None:
    how long a silent service is trusted is for the motor side to decide.
    """

    def __init__(self, database: Database) -> None:
        messages = database.messages
        self._ceilings = ceiling_codes(messages["TorqueLimit"])
        unlimited = tuple(code.no_limit_nm for code in self._ceilings)
        self._torque = Mailbox(messages["TorqueLimit"], (*unlimited, 0, 0, TcsState.OFF))
        self._status = Mailbox(messages["TcsStatus"], (0.0, 0.0, 0.0, ControllerKind.OFF, 0, 0))
        self._estimates = Mailbox(messages["TcsEstimates"], (0.0, 0.0, 0.0, 0.0, 0.0))
        self._bench_done = Mailbox(messages["BenchTickDone"], (0,))
        self._inbox = Inbox(
            [self._torque, self._status, self._estimates, self._bench_done],
            own_ids=database.frame_ids_of(VEHICLE),
        )
        self._bench = Outbox(messages["BenchTick"])
        self._cyclic = _cyclic_outboxes(database)

    @property
    def counters(self) -> InboxCounters:
        """What became of the frames fed so far."""
        return self._inbox.counters

    @property
    def limits(self) -> TorqueLimits:
        """Newest torque ceilings."""
        left, right = self._ceilings
        return TorqueLimits(
            left.from_bus(self._torque.values[0]), right.from_bus(self._torque.values[1])
        )

    @property
    def limits_stamp_ns(self) -> int | None:
        """When the newest ceilings came, None before the first."""
        return self._torque.stamp_ns

    @property
    def service(self) -> ServiceStatus:
        """What the service last said about itself; OFF and zeros before it speaks.

        A state or controller outside of the value table reads as FAULT and OFF.
        """
        _, _, active_left, active_right, state = self._torque.values
        slip_left, slip_right, reference, controller, fault_code, overruns = self._status.values
        return ServiceStatus(
            state=_STATES.get(int(state), TcsState.FAULT),
            active=(bool(active_left), bool(active_right)),
            slip_ratio=(slip_left, slip_right),
            slip_reference=reference,
            controller=_CONTROLLERS.get(int(controller), ControllerKind.OFF),
            fault_code=int(fault_code),
            tick_overruns=int(overruns),
        )

    @property
    def road(self) -> RoadEstimate:
        """What the service last said it believes about road and loop; zeros before it speaks."""
        mu_left, mu_right, sure_left, sure_right, delay_ms = self._estimates.values
        return RoadEstimate((mu_left, mu_right), (sure_left, sure_right), delay_ms * 1e-3)

    @property
    def bench_tick_done(self) -> int | None:
        """Newest lockstep tick the service has answered, None before the first."""
        return None if self._bench_done.stamp_ns is None else int(self._bench_done.values[0])

    def feed(self, frame_id: int, data: bytes, stamp_ns: int) -> bool:
        """Take one frame; True if it was good and its values are now the newest."""
        return self._inbox.feed(frame_id, data, stamp_ns)

    def frames(self, signals: VehicleSignals, now_ns: int) -> list[OutgoingFrame]:
        """Frames due at ``now_ns``, lowest identifier first as on the wire."""
        return [
            outbox.frame(*values_of(signals))
            for outbox, values_of in self._cyclic
            if outbox.is_due(now_ns)
        ]

    def bench_tick(self, tick: int) -> OutgoingFrame:
        """Tell the service, in lockstep, that every frame of this tick has been sent."""
        return self._bench.frame(tick)


def _cyclic_outboxes(
    database: Database,
) -> list[tuple[Outbox, Callable[[VehicleSignals], _Values]]]:
    specs = sorted((database.messages[name] for name in _VALUES), key=lambda spec: spec.frame_id)
    return [(Outbox(spec), _VALUES[spec.name]) for spec in specs]
