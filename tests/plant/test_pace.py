"""Both paces over the embedded bus, against a service with one idea."""

import itertools
import threading
from contextlib import closing

import numpy as np
import pytest

from plant_emulator.emulator import PERIOD_NS, Emulator
from plant_emulator.lockstep import run_lockstep
from plant_emulator.plant import Plant
from plant_emulator.realtime import run_realtime
from plant_emulator.recording import TruthRecorder
from tcs_hil.canbus.bus import open_bus
from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.port import CanPort, Frame
from tcs_hil.canbus.vehicle_node import VehicleNode
from tcs_hil.errors import BusError


def never():
    return False


def emulator_for(scenario, port, *, live=True):
    recorder = TruthRecorder(None, scenario, in_memory=True)
    return Emulator(Plant(scenario), VehicleNode(load_database()), port, recorder, live=live)


def lockstep_run(scenario, channel, service, limit_nm):
    bus, _ = open_bus("embedded", channel)
    with service(channel, limit_nm) as peer, closing(CanPort(bus, send_timeout_s=1.0)) as port:
        emulator = emulator_for(scenario, port, live=False)
        run_lockstep(emulator, port, never)
    return peer, emulator.plant.truth


def test_in_lockstep_the_limits_of_a_tick_act_in_the_same_tick(launch, channel, service):
    peer, truth = lockstep_run(launch, channel, service, limit_nm=40.0)
    assert len(peer.measurements) == 50
    assert peer.measurements[0].driver_torque_nm == (250.0, 250.0)
    assert peer.measurements[1].motor_torque_nm == (40.0, 40.0)
    assert truth.motor_torque_nm == (40.0, 40.0)


def test_lockstep_runs_send_the_same_bytes(launch, channel, service):
    first, _ = lockstep_run(launch, channel, service, limit_nm=40.0)
    second, _ = lockstep_run(launch, channel, service, limit_nm=40.0)
    assert first.received == second.received


def test_frames_of_a_tick_come_by_ascending_identifier_and_bench_tick_last(
    launch, channel, service
):
    peer, _ = lockstep_run(launch, channel, service, limit_nm=40.0)
    ids = [frame_id for frame_id, _ in peer.received]
    bench = max(ids)
    ticks = [
        list(g) for is_bench, g in itertools.groupby(ids, lambda i: i == bench) if not is_bench
    ]
    assert len(ticks) == 50
    assert all(tick == sorted(tick) for tick in ticks)


def test_a_silent_service_is_named_in_one_sentence(launch, channel):
    with closing(CanPort(open_bus("embedded", channel)[0])) as port:
        emulator = emulator_for(launch, port, live=False)
        with pytest.raises(BusError, match=r"no answer to tick 0 .* start `tcs-hil run"):
            run_lockstep(emulator, port, never, timeout_s=0.01)


def test_lockstep_stops_when_asked(launch, channel):
    stop = threading.Event()
    with closing(CanPort(open_bus("embedded", channel)[0])) as port:
        emulator = emulator_for(launch, port, live=False)
        stop.set()
        run_lockstep(emulator, port, stop.is_set)
    assert emulator.plant.time_s == 0.0


class ScriptedClock:
    """A clock that wakes as late as the script says."""

    def __init__(self, lateness_ns=()):
        self.time_ns = 123
        self._lateness_ns = iter(lateness_ns)

    def now_ns(self):
        return self.time_ns

    def sleep_until(self, deadline_ns):
        self.time_ns = max(self.time_ns, deadline_ns + next(self._lateness_ns, 0))


class ScriptedPort:
    """A port that has received what the script says by now."""

    def __init__(self, clock, frames=()):
        self.sent = []
        self._clock = clock
        self._frames = sorted(frames, key=lambda frame: frame.stamp_ns)

    def receive(self):
        due = [frame for frame in self._frames if frame.stamp_ns <= self._clock.time_ns]
        self._frames = self._frames[len(due) :]
        return due

    def send(self, frame_id, data):
        self.sent.append((self._clock.time_ns, frame_id))
        return True


def test_the_real_time_grid_is_absolute_and_keeps_its_phase(launch):
    clock = ScriptedClock(lateness_ns=[100_000, 300_000, 0, 50_000])
    port = ScriptedPort(clock)
    jitter_ns = run_realtime(emulator_for(launch, port), port, clock, never, phase_ns=500_000)
    assert list(jitter_ns[:5]) == [100_000, 300_000, 0, 50_000, 0]
    assert port.sent[-1][0] % PERIOD_NS == 500_000
    assert jitter_ns.size == 51  # both ends of a tenth of a second


def test_a_late_wake_up_skips_instants_and_sends_no_burst(launch):
    clock = ScriptedClock(lateness_ns=[0, 0, 7_100_000])
    port = ScriptedPort(clock)
    jitter_ns = run_realtime(emulator_for(launch, port), port, clock, never)
    instants = sorted({sent_ns for sent_ns, _ in port.sent})
    assert min(np.diff(instants)) > 800_000
    assert clock.time_ns == pytest.approx(PERIOD_NS + 100_000_000)
    assert jitter_ns.size == 51 - 3  # one wake-up for the instants 2 to 5


def test_in_real_time_a_limit_acts_from_its_receive_stamp(launch, command_frame):
    clock = ScriptedClock()
    limit_id, data = command_frame(40.0)
    stamp_ns = PERIOD_NS + 4_700_000  # 0.7 ms into the third period of the run
    port = ScriptedPort(clock, [Frame(limit_id, data, stamp_ns)])
    emulator = emulator_for(launch, port)
    spy = []
    step = emulator.plant.step
    emulator.plant.step = lambda limits, dt_s: (
        spy.append((emulator.plant.time_s, limits)),
        step(limits, dt_s),
    )
    run_realtime(emulator, port, clock, never)
    ((time_s, limits),) = [entry for entry in spy if entry[1] is not None]
    assert time_s == pytest.approx(0.0047)
    assert limits == (40.0, 40.0)


def test_in_real_time_frames_leave_when_their_last_bit_has_passed(launch):
    clock = ScriptedClock()
    port = ScriptedPort(clock)
    run_realtime(emulator_for(launch.with_variant("vehicle"), port), port, clock, never)
    ids = [frame_id for _, frame_id in port.sent[:4]]
    assert ids == sorted(ids)
    ends_us = [(sent_ns - PERIOD_NS) / 1000 for sent_ns, _ in port.sent[:4]]
    gaps_us = np.diff([0.0, *ends_us])
    # At 2 us a bit: 5, 8, 6 and 8 bytes make 90 to 136 bits, stuff bits included.
    assert all(180 < gap < 275 for gap in gaps_us)


def test_the_recording_is_read_with_numpy_alone(launch, tmp_path):
    clock = ScriptedClock()
    port = ScriptedPort(clock)
    path = tmp_path / "truth.npz"
    recorder = TruthRecorder(path, launch)
    emulator = Emulator(Plant(launch), VehicleNode(load_database()), port, recorder)
    recorder.save(run_realtime(emulator, port, clock, never))
    with np.load(path) as file:
        truth, jitter_ns = file["truth"], file["jitter_ns"]
    assert truth["time_s"] == pytest.approx(np.arange(51) * 0.002)
    assert truth["slip_ratio"].shape == (51, 4)
    assert truth["motor_torque_nm"][10] == pytest.approx([250.0, 250.0])
    assert jitter_ns.size == 51
