"""From frames of both nodes to what is shown, without a bus."""

import pytest
from factories import command

from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.canbus.vehicle_node import VehicleNode, VehicleSignals
from tcs_hil.fault_codes import FaultCode
from tcs_hil.hil.monitor.bus_view import BusView
from tcs_hil.hil.monitor.snapshot import Snapshot
from tcs_hil.signals import NO_LIMIT, Command, RoadEstimate

DATABASE = load_database()
PERIOD_NS = 2_000_000
SIGNALS = VehicleSignals(
    wheel_speed_radps=(50.0, 45.0, 40.0, 41.0),
    wheel_speed_valid=(True, True, True, True),
    motor_speed_radps=(150.0, 135.0),
    motor_torque_nm=(95.0, 96.0),
    driver_torque_nm=(250.0, 250.0),
)


def decided(slip: float = 0.1, fault: int = FaultCode.REAR_SPEED_LATE) -> Command:
    return command(
        *(100.0, NO_LIMIT),
        fault_code=fault,
        slip_ratio=(slip, 0.05),
        slip_reference=0.12,
        road=RoadEstimate((0.3, 0.4), (0.9, 0.8), 0.006),
    )


class Traffic:
    """Both nodes talking, and the view that hears them."""

    def __init__(self) -> None:
        self.view = BusView(DATABASE, "test")
        self.now_ns = 0
        self._vehicle, self._service = VehicleNode(DATABASE), TcsNode(DATABASE)

    def run(self, ticks: int, slip: float = 0.1) -> Snapshot:
        for _ in range(ticks):
            self.now_ns += PERIOD_NS
            frames = self._vehicle.frames(SIGNALS, self.now_ns)
            frames += self._service.frames(decided(slip), self.now_ns, tick_overruns=3)
            for frame_id, data in frames:
                self.view.feed(frame_id, data, self.now_ns)
        return self.view.snapshot(self.now_ns)


def test_before_anything_is_heard_nothing_is_claimed() -> None:
    snapshot = BusView(DATABASE, "test").snapshot(0)
    assert snapshot.silent_s is None
    assert snapshot.state == "OFF"
    assert snapshot.rates_hz == snapshot.times == {}


def test_what_both_nodes_say_is_shown() -> None:
    snapshot = Traffic().run(20)
    assert (snapshot.state, snapshot.controller) == ("ACTIVE", "NMPC")
    assert snapshot.fault_code == 12
    assert "rear wheel speeds are missing" in snapshot.fault
    assert snapshot.slip_reference == pytest.approx(0.12)
    left, right = snapshot.left, snapshot.right
    assert (left.slip_ratio, right.slip_ratio) == pytest.approx((0.1, 0.05))
    assert (left.limit_nm, right.limit_nm) == (100.0, None)
    assert (left.allowed_nm, right.allowed_nm) == (100.0, 250.0)
    assert (left.motor_nm, left.wheel_speed_radps, left.rear_speed_radps) == (95.0, 50.0, 40.0)
    assert (right.mu_ratio, right.mu_confidence) == pytest.approx((0.4, 0.8))
    assert snapshot.counts["overruns"] == 3


def test_rates_and_cycle_times_are_those_of_the_last_seconds() -> None:
    snapshot = Traffic().run(1500)
    assert snapshot.rates_hz["TorqueLimit"] == 500
    assert snapshot.rates_hz["DriverRequest"] == 100
    assert snapshot.times["limit cycle"].p50_us == snapshot.times["limit cycle"].max_us == 2000


def test_a_bus_that_fell_silent_has_no_rate() -> None:
    traffic = Traffic()
    traffic.run(1000)
    snapshot = traffic.view.snapshot(traffic.now_ns + 3_000_000_000)
    assert snapshot.silent_s == pytest.approx(3.0)
    assert set(snapshot.rates_hz.values()) == {0.0}
    assert snapshot.times == {}


def test_damaged_frames_and_strangers_are_counted() -> None:
    traffic = Traffic()
    traffic.run(1)
    limit = DATABASE.messages["TorqueLimit"]
    traffic.view.feed(limit.frame_id, bytes(limit.length), traffic.now_ns)
    traffic.view.feed(0x123, b"", traffic.now_ns)
    snapshot = traffic.view.snapshot(traffic.now_ns)
    assert snapshot.counts["e2e_errors"] == 1
    assert snapshot.rates_hz["others"] == 1


def test_a_peak_between_two_drawings_is_on_the_curve() -> None:
    traffic = Traffic()
    traffic.run(40)
    traffic.run(10, slip=0.7)
    traffic.run(460)
    slips = [point.slip[0] for point in traffic.view.history.points]
    assert max(slips) == pytest.approx(0.7)
    assert slips[-1] == pytest.approx(0.1)
