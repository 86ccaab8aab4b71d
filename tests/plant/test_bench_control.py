"""A hand on the emulator: obeyed only where it was allowed, and gone when it lets go."""

import msgspec
import pytest
from factories import command

from plant_emulator.bench_control import PREPARED
from plant_emulator.emulator import PERIOD_NS, Emulator
from plant_emulator.faults import Fault
from plant_emulator.plant import Plant
from plant_emulator.recording import TruthRecorder
from plant_emulator.scenario import load_scenario
from tcs_hil.canbus.bench_control import AS_IN_SCENARIO, BenchControl, BenchFault
from tcs_hil.canbus.bench_node import BenchNode
from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.canbus.vehicle_node import VehicleNode

DATABASE = load_database()
IDS = {name: spec.frame_id for name, spec in DATABASE.messages.items()}
FL = 0


class Bench:
    """An emulator without a bus, and a person in front of it."""

    def __init__(self, scenario, command, *, allow_control=True):
        self.person = BenchNode(DATABASE)
        self.service = TcsNode(DATABASE)
        self.heard = set()
        self.emulator = Emulator(
            Plant(scenario),
            VehicleNode(DATABASE),
            self,
            TruthRecorder(None, scenario, in_memory=True),
            allow_control=allow_control,
        )
        self._command = command
        self._now_ns = 0

    def send(self, frame_id, data):
        self.heard.add(frame_id)
        return self.service.feed(frame_id, data, self._now_ns)

    def ask(self, control):
        frame_id, data = self.person.frame(control)
        self.emulator.hear(frame_id, data, self._now_ns)
        return self

    def run(self, ticks=10):
        """Drive on; returns what was measured at the end."""
        self.heard.clear()
        for _ in range(ticks):
            self.emulator.publish()
            for frame_id, data in self.service.frames(self._command, self._now_ns):
                self.emulator.hear(frame_id, data, self._now_ns)
            self._now_ns += PERIOD_NS
            self.emulator.advance_to(self._now_ns)
        return self.service.measurement(self._now_ns)

    @property
    def truth(self):
        return self.emulator.plant.truth


@pytest.fixture
def bench():
    """Make a bench whose driver asks for 50 Nm on mu 1: ``bench(allow_control=False)``."""

    def make(*, faults=(), **options):
        scenario = load_scenario("manoeuvre-1").with_variant("vehicle")
        driver = msgspec.structs.replace(scenario.driver, request=((0.0, 50.0),))
        scenario = msgspec.structs.replace(
            scenario, driver=driver, start_speed_kmph=20.0, fault=faults
        )
        return Bench(scenario, command(400.0, 400.0), **options)

    return make


def test_nobody_moves_the_car_unless_the_emulator_was_started_to_allow_it(bench):
    closed = bench(allow_control=False)
    measured = closed.ask(BenchControl(throttle_nm=200.0)).run()
    assert measured.driver_torque_nm == (50.0, 50.0)
    assert closed.emulator.refused_controls == 1


def test_the_throttle_is_the_persons_until_given_back(bench):
    car = bench()
    assert car.ask(BenchControl(throttle_nm=120.0)).run().driver_torque_nm == (120.0, 120.0)
    assert car.truth.motor_torque_nm[0] > 60.0
    assert car.ask(AS_IN_SCENARIO).run().driver_torque_nm == (50.0, 50.0)


def test_the_road_is_the_persons_until_given_back(bench):
    car = bench()
    before = car.truth.mu
    car.ask(BenchControl(mu_ratio=0.12)).run()
    assert car.truth.mu == pytest.approx((0.12,) * 4)
    car.ask(AS_IN_SCENARIO).run()
    assert car.truth.mu == pytest.approx(before)


def test_a_road_without_any_friction_is_taken_as_the_slipperiest_there_is(bench):
    car = bench()
    car.ask(BenchControl(mu_ratio=0.0)).run()
    assert car.truth.mu[FL] == pytest.approx(0.01)


def test_a_damaged_control_frame_is_not_obeyed(bench):
    car = bench()
    frame_id, data = car.person.frame(BenchControl(throttle_nm=200.0))
    car.emulator.hear(frame_id, bytes([data[0] ^ 0xFF]) + data[1:], 0)
    car.emulator.hear(frame_id, data[:-1], 0)
    assert car.run().driver_torque_nm == (50.0, 50.0)


def test_every_fault_of_the_value_table_is_prepared():
    assert set(PREPARED) == set(BenchFault)


def test_a_message_is_dropped_for_as_long_as_it_is_asked_for(bench):
    car = bench()
    car.ask(BenchControl(fault=BenchFault.WHEEL_SPEEDS_REAR_DROPPED)).run()
    assert IDS["WheelSpeedsRear"] not in car.heard
    assert IDS["WheelSpeedsFront"] in car.heard
    car.ask(AS_IN_SCENARIO).run()
    assert IDS["WheelSpeedsRear"] in car.heard


def test_a_stuck_sensor_stays_where_it_was_while_the_person_does_something_else(bench):
    car, stuck = bench(), BenchFault.WHEEL_SPEED_FL_STUCK
    held = car.ask(BenchControl(throttle_nm=200.0, fault=stuck)).run().wheel_speed_radps[FL]
    car.ask(BenchControl(throttle_nm=250.0, fault=stuck))
    assert car.run(100).wheel_speed_radps[FL] == held
    assert car.truth.wheel_speed_radps[FL] > held + 1.0


def test_faults_of_the_scenario_remember_how_they_began(bench):
    car = bench(faults=(Fault(target="WheelSpeedFR", kind="stuck"),))
    held = car.ask(BenchControl(throttle_nm=200.0)).run().wheel_speed_radps[1]
    car.ask(BenchControl(throttle_nm=200.0, fault=BenchFault.WHEEL_SPEED_RL_OFF))
    measured = car.run(100)
    assert measured.wheel_speed_radps[1] == held
    assert not measured.wheel_speed_valid[2]


def test_a_car_without_electricity_still_gets_it_back(bench):
    car = bench()
    car.ask(BenchControl(fault=BenchFault.VEHICLE_BROWN_OUT)).run(50)
    assert not car.heard
    assert car.truth.motor_torque_nm[0] == pytest.approx(0.0, abs=1.0)
    car.ask(AS_IN_SCENARIO).run(50)
    assert car.truth.motor_torque_nm[0] > 40.0
    assert car.heard


def test_a_babble_that_begins_late_does_not_make_up_for_the_past(bench):
    car = bench()
    car.run(500)
    car.ask(BenchControl(fault=BenchFault.VEHICLE_BABBLING)).run(2)
    car.ask(AS_IN_SCENARIO).run(5)
    assert car.run(1).rear_speed_age_s < 0.004


def test_the_same_drive_with_and_without_leave_is_the_same(bench):
    open_bench, closed = bench(), bench(allow_control=False)
    open_bench.run(50)
    closed.run(50)
    assert open_bench.truth == closed.truth
