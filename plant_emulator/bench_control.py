"""A person's hand on the running emulator, where it was started to allow one."""

from __future__ import annotations

from plant_emulator.faults import Fault
from tcs_hil.canbus.bench_control import BenchControl, BenchFault
from tcs_hil.canbus.bench_node import BenchInbox
from tcs_hil.canbus.database import Database

PREPARED: dict[BenchFault, tuple[Fault, ...]] = {
    BenchFault.NONE: (),
    BenchFault.WHEEL_SPEED_FL_STUCK: (Fault(target="WheelSpeedFL", kind="stuck"),),
    BenchFault.WHEEL_SPEED_RL_OFF: (Fault(target="WheelSpeedRL", kind="off"),),
    BenchFault.WHEEL_SPEEDS_REAR_DROPPED: (Fault(target="WheelSpeedsRear", kind="dropped"),),
    BenchFault.DRIVER_REQUEST_WRONG_CRC: (Fault(target="DriverRequest", kind="wrong-crc"),),
    BenchFault.MOTOR_STATE_DROPPED: (Fault(target="MotorState", kind="dropped"),),
    BenchFault.TORQUE_LIMIT_DROPPED: (Fault(target="TorqueLimit", kind="dropped"),),
    BenchFault.VEHICLE_BABBLING: (Fault(target="VEHICLE", kind="babbling", period_s=0.0003),),
    BenchFault.VEHICLE_BROWN_OUT: (Fault(target="VEHICLE", kind="brown-out"),),
}
"""What each fault that can be asked for is made of; it lasts for as long as it is asked for."""


class ControlDesk:
    """Hears the control frames of the bench, and passes on those that may be obeyed.

    It belongs to the bench and not to the car: neither the car's faults nor its
    restarts touch it.  ``refused`` counts the frames that came although nobody
    had allowed any.
    """

    def __init__(self, database: Database, *, allowed: bool) -> None:
        self._inbox = BenchInbox(database)
        self._allowed = allowed
        self.frame_id = self._inbox.frame_id
        self.refused = 0

    def hear(self, data: bytes, stamp_ns: int) -> BenchControl | None:
        """Take one control frame; what it asks for, or None where it is not to be obeyed."""
        if not self._allowed:
            self.refused += 1
            return None
        return self._inbox.control if self._inbox.feed(data, stamp_ns) else None
