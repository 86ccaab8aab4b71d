"""The plant on its emulated wire, in process: delays, rates, restarts, and the whole library."""

from collections import Counter

import msgspec
import numpy as np
import pytest
from factories import command

from plant_emulator.bustiming import BusTiming
from plant_emulator.emulator import PERIOD_NS, Emulator
from plant_emulator.plant import Plant
from plant_emulator.recording import TruthRecorder
from plant_emulator.scenario import list_scenarios, load_scenario
from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.canbus.vehicle_node import VehicleNode

DATABASE = load_database()


class Bench:
    """A service that always answers the same, without a bus."""

    def __init__(self, scenario, command):
        self.heard = []
        self.node = TcsNode(DATABASE)
        self.recorder = TruthRecorder(None, scenario, in_memory=True)
        self.emulator = Emulator(Plant(scenario), VehicleNode(DATABASE), self, self.recorder)
        self._command = command
        self._now_ns = 0

    def send(self, frame_id, data):
        self.heard.append((self._now_ns, frame_id))
        self.node.feed(frame_id, data, self._now_ns)
        return True

    def run(self, ticks):
        for _ in range(ticks):
            self.emulator.publish()
            for frame_id, data in self.node.frames(self._command, self._now_ns):
                self.emulator.hear(frame_id, data, self._now_ns)
            self._now_ns += PERIOD_NS
            self.emulator.advance_to(self._now_ns)
        return self.recorder.rows


@pytest.fixture
def bench():
    """Make a bench for a whole car launched at full throttle from 20 km/h: ``bench(bus={...})``."""

    def make(limit_nm=40.0, **changes):
        scenario = load_scenario("manoeuvre-1").with_variant("vehicle")
        driver = msgspec.structs.replace(scenario.driver, request=((0.0, 250.0),))
        scenario = msgspec.structs.replace(
            scenario, driver=driver, start_speed_kmph=20.0, **changes
        )
        return Bench(scenario, command(limit_nm, limit_nm))

    return make


def first_limited_s(rows):
    return rows["time_s"][np.argmax(np.isfinite(rows["limit_nm"][:, 0]))]


def test_every_message_goes_out_at_its_cycle(bench):
    ids = Counter(frame_id for _, frame_id in _heard(bench(), 100))
    cycles = {
        DATABASE.messages[name].frame_id: DATABASE.messages[name].cycle_ns
        for name in ("DriverRequest", "MotorState", "WheelSpeedsFront", "WheelSpeedsRear")
    }
    assert ids == {frame_id: 200_000_000 // cycle_ns for frame_id, cycle_ns in cycles.items()}


def _heard(bench, ticks):
    bench.run(ticks)
    return bench.heard


def test_without_a_bus_limits_act_at_once(bench):
    rows = bench(bus=BusTiming(bitrate=0, limit_delay_s=0.0, answer_s=0.0)).run(10)
    assert first_limited_s(rows) == pytest.approx(0.002)


def test_by_default_a_limit_acts_three_ticks_after_its_sample(bench):
    """1.7 ms to the answer, a quarter on the wire, 4 ms in gateway and inverter."""
    rows = bench().run(10)
    assert first_limited_s(rows) == pytest.approx(0.006)


def test_a_service_that_reads_at_once_finds_the_frames_of_the_tick_before(bench):
    heard = _heard(bench(bus=BusTiming(answer_s=0.0)), 10)
    assert min(stamp for stamp, _ in heard) == PERIOD_NS


def test_runs_repeat_to_the_bit_with_jitter_load_and_loss(bench):
    bus = BusTiming(background_load=0.4, jitter_s=0.0005, loss_ratio=0.02)
    first, again = (bench(bus=bus) for _ in range(2))
    assert first.run(200).tobytes() == again.run(200).tobytes()
    assert first.heard == again.heard


def test_jitter_delays_frames_but_loses_none(bench):
    calm, nervous = (bench(bus=BusTiming(jitter_s=jitter)) for jitter in (0.0, 0.001))
    for each in (calm, nervous):
        each.run(100)
    assert nervous.node.counters.wrong_sequence == 0
    assert len(nervous.heard) == pytest.approx(len(calm.heard), abs=4)


def test_after_a_brown_out_the_node_starts_with_fresh_counters(bench):
    scenario = load_scenario("fault-brown-out")
    running = bench(fault=scenario.fault)
    running.run(1000)
    dark = [stamp for stamp, _ in running.heard if 1_002_000_000 < stamp < 1_498_000_000]
    assert dark == []
    assert max(stamp for stamp, _ in running.heard) > 1_990_000_000


def test_limits_that_are_lost_are_held_and_then_released(bench):
    rows = bench(fault=load_scenario("fault-limit-lost").fault).run(900)
    lost = (rows["time_s"] > 1.2) & (rows["time_s"] < 1.4)
    assert np.diff(rows["limit_nm"][lost, 0]) == pytest.approx(500.0 * 0.002)
    assert rows["limit_nm"][-1, 0] == 40.0


def test_a_babbling_node_fills_the_wire_but_not_for_ever(bench):
    """Once it is over nothing stale follows: no more frames than were made since."""
    (fault,) = load_scenario("fault-babbling").fault
    running = bench(fault=(fault,))
    rows = running.run(1000)
    assert np.isfinite(rows["limit_nm"][-1, 0])
    end_ns = round(fault.end * 1e9)
    after = [frame_id for stamp, frame_id in running.heard if 0 <= stamp - end_ns < 50_000_000]
    front_id = DATABASE.messages["WheelSpeedsFront"].frame_id
    assert Counter(after)[front_id] == pytest.approx(25, abs=1)
    assert Counter(after)[fault.frame_id] <= 2


@pytest.mark.parametrize("name", [listing.name for listing in list_scenarios()])
def test_every_shipped_scenario_drives(name):
    scenario = load_scenario(name)
    rows = Bench(scenario, command(110.0, 110.0)).run(600)
    for field in ("speed_mps", "slip_ratio", "force_n", "load_n", "motor_torque_nm"):
        assert np.isfinite(rows[field]).all()
    assert rows["load_n"].min() > 1000.0
    assert np.abs(rows["slip_ratio"]).max() < 1.5
