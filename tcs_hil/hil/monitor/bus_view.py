"""What a bus says about the car and the service.  Pure: stamps are arguments."""

from __future__ import annotations

from collections import deque
from itertools import pairwise

from tcs_hil.canbus.contract import BENCH, TCS
from tcs_hil.canbus.database import Database
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.canbus.vehicle_node import VehicleNode
from tcs_hil.fault_codes import MEANINGS
from tcs_hil.hil.monitor.history import History
from tcs_hil.hil.monitor.snapshot import Side, Snapshot, Spread, spread
from tcs_hil.signals import NO_LIMIT

S_IN_NS = 1_000_000_000
WINDOW_NS = 2 * S_IN_NS
STRANGERS = "others"
_MEANINGS = {int(code): text for code, text in MEANINGS.items()}


def meaning(fault_code: int) -> str:
    """What a fault code says, for people."""
    return _MEANINGS.get(fault_code, "a code this version does not know")


class BusView:
    """Listens to both nodes at once, through the mailboxes of the other one."""

    def __init__(self, database: Database, source: str) -> None:
        self.history = History()
        self._source = source
        self._vehicle = VehicleNode(database)
        self._service = TcsNode(database)
        self._specs = {spec.frame_id: spec for spec in database.messages.values()}
        self._stamps: dict[str, deque[int]] = {}
        self._heard_ns: int | None = None

    def feed(self, frame_id: int, data: bytes, stamp_ns: int) -> None:
        """Take one frame of anybody."""
        spec = self._specs.get(frame_id)
        self._heard_ns = stamp_ns
        name = STRANGERS if spec is None else spec.name
        self._stamps.setdefault(name, deque(maxlen=20_000)).append(stamp_ns)
        if spec is None or spec.sender == BENCH:
            return
        listener = self._vehicle if spec.sender == TCS else self._service
        if listener.feed(frame_id, data, stamp_ns) and spec.name == "TcsStatus":
            sides = self._side(0, stamp_ns), self._side(1, stamp_ns)
            self.history.add(stamp_ns, *sides, self._vehicle.service.slip_reference)

    def snapshot(self, now_ns: int) -> Snapshot:
        """Everything that is known at ``now_ns``."""
        status = self._vehicle.service
        seen = self._heard_ns
        return Snapshot(
            source=self._source,
            silent_s=None if seen is None else max(now_ns - seen, 0) / S_IN_NS,
            state=status.state.name,
            controller=status.controller.name,
            fault_code=status.fault_code,
            fault=meaning(status.fault_code),
            slip_reference=status.slip_reference,
            vehicle_speed_mps=None,
            left=self._side(0, now_ns),
            right=self._side(1, now_ns),
            times=self._times(now_ns),
            rates_hz=self._rates(now_ns),
            counts=self._counts(),
        )

    def _side(self, side: int, now_ns: int) -> Side:
        measured = self._service.measurement(now_ns)
        limit_nm = self._vehicle.limits[side]
        road = self._vehicle.road
        return Side(
            slip_ratio=self._vehicle.service.slip_ratio[side],
            wheel_speed_radps=measured.wheel_speed_radps[side],
            rear_speed_radps=measured.wheel_speed_radps[2 + side],
            request_nm=measured.driver_torque_nm[side],
            limit_nm=None if limit_nm == NO_LIMIT else limit_nm,
            motor_nm=measured.motor_torque_nm[side],
            mu_ratio=road.friction_ratio[side],
            mu_confidence=road.confidence_ratio[side],
        )

    def _times(self, now_ns: int) -> dict[str, Spread]:
        stamps = [s for s in self._stamps.get("TorqueLimit", ()) if s > now_ns - WINDOW_NS]
        cycle = spread((later - earlier) * 1e-3 for earlier, later in pairwise(stamps))
        return {} if cycle is None else {"limit cycle": cycle}

    def _rates(self, now_ns: int) -> dict[str, float]:
        for stamps in self._stamps.values():
            while stamps and stamps[0] <= now_ns - WINDOW_NS:
                stamps.popleft()
        return {
            name: float(sum(stamp > now_ns - S_IN_NS for stamp in stamps))
            for name, stamps in self._stamps.items()
        }

    def _counts(self) -> dict[str, int]:
        heard = (self._vehicle.counters, self._service.counters)
        return {
            "e2e_errors": sum(c.e2e_error for c in heard),
            "e2e_repeated": sum(c.repeated for c in heard),
            "e2e_wrong_sequence": sum(c.wrong_sequence for c in heard),
            "overruns": self._vehicle.service.tick_overruns,
        }
