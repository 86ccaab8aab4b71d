"""Each fault does what it says, when it says so, and nothing else."""

import math

import numpy as np
import pytest

from plant_emulator.faults import Fault, next_boundary
from plant_emulator.frame_faults import FrameFaults, TimedFrame
from plant_emulator.signal_faults import LimitFaults
from plant_emulator.value_faults import alteration
from plant_emulator.virtual_bus import Sender
from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.canbus.vehicle_node import VehicleNode, VehicleSignals
from tcs_hil.signals import NO_LIMIT, TorqueLimits

DATABASE = load_database()
FRONT_ID = DATABASE.messages["WheelSpeedsFront"].frame_id
SIGNALS = VehicleSignals(
    wheel_speed_radps=(20.0, 21.0, 22.0, 23.0),
    wheel_speed_valid=(True,) * 4,
    motor_speed_radps=(60.0, 63.0),
    motor_torque_nm=(50.0, 51.0),
    driver_torque_nm=(100.0, 100.0),
    accel_x_mps2=1.0,
)


def altered(fault, values=None):
    """Value of a ramp 0, 1, 2... sampled every 10 ms, altered."""
    alter = alteration(
        Fault(target="WheelSpeedFL", start_s=0.05, end_s=0.15, **fault), np.random.default_rng(0)
    )
    values = range(20) if values is None else values
    return [alter(float(value), index * 0.01 + 0.001) for index, value in enumerate(values)]


def test_off_leaves_nothing():
    assert altered({"kind": "off"})[3:8] == [3.0, 4.0, None, None, None]
    assert altered({"kind": "off"})[15] == 15.0


def test_stuck_holds_the_last_good_value():
    assert altered({"kind": "stuck"}) == [0, 1, 2, 3, 4, *[4] * 10, 15, 16, 17, 18, 19]


def test_garbage_is_within_its_bounds_and_differs_every_time():
    during = altered({"kind": "garbage", "low": 100.0, "high": 200.0})[5:15]
    assert all(100.0 <= value <= 200.0 for value in during)
    assert len(set(during)) == 10


def test_wrong_is_scaled_and_offset():
    assert altered({"kind": "wrong", "scale": 2.0, "offset": -1.0})[4:6] == [4.0, 9.0]


def test_slow_lags_by_its_time_constant():
    step = [0.0] * 5 + [1.0] * 15
    after = altered({"kind": "slow", "time_constant_s": 0.03}, step)
    assert after[7] == pytest.approx(1 - math.exp(-1.0))


def test_delayed_is_as_old_as_it_says():
    assert altered({"kind": "delayed", "delay_s": 0.03})[4:8] == [4.0, 2.0, 3.0, 4.0]


def test_intermittent_comes_and_goes():
    pattern = altered({"kind": "intermittent", "period_s": 0.04, "duty": 0.5})[5:13]
    assert [value is None for value in pattern] == [True, True, False, False] * 2


def test_boundaries_are_known_in_advance():
    faults = [Fault(target="MotorL", kind="off", start_s=1.0, end_s=2.0)]
    assert [next_boundary(faults, time) for time in (0.0, 1.0, 2.0)] == [1.0, 2.0, math.inf]


def test_an_intermittent_fault_knows_all_its_edges():
    fault = Fault(
        target="MotorL", kind="intermittent", start_s=0.1, end_s=0.14, period_s=0.03, duty=0.4
    )
    time_s, edges, states = 0.0, [], []
    while (time_s := fault.next_edge(time_s)) < math.inf:
        edges.append(time_s)
        states.append(fault.active(time_s))
    assert edges == pytest.approx([0.1, 0.112, 0.13, 0.14])
    assert states == [True, False, True, False]


@pytest.mark.parametrize(
    ("fault", "named"),
    [
        ({"target": "Wheel", "kind": "off"}, "target"),
        ({"target": "MotorState", "kind": "stuck"}, "kind"),
        ({"target": "TcsStatus", "kind": "wrong-crc"}, "kind"),
        ({"target": "MotorL", "kind": "off", "start_s": 2.0, "end_s": 1.0}, "end_s"),
    ],
)
def test_a_fault_that_cannot_be_is_refused(fault, named):
    with pytest.raises(ValueError, match=f"`{named}`"):
        Fault(**fault)


def frames_under(count, **fault):
    """What a service makes of ``count`` cycles of front wheel-speed frames under a fault."""
    faults = FrameFaults((Fault(**fault),), DATABASE, np.random.default_rng(0))
    vehicle, service = VehicleNode(DATABASE), TcsNode(DATABASE)
    passed = []
    for cycle in range(count):
        time_ns = cycle * 2_000_000
        for frame_id, data in vehicle.frames(SIGNALS, time_ns):
            if frame_id == FRONT_ID:
                for frame in faults.pass_on(TimedFrame(time_ns, frame_id, data), Sender.VEHICLE):
                    passed.append(frame)
                    service.feed(frame.frame_id, frame.data, frame.time_ns)
    return passed, service.counters


FRONT = {"target": "WheelSpeedsFront", "start_s": 0.02, "end_s": 0.04}


def test_dropped_frames_are_gone_while_it_lasts():
    passed, counters = frames_under(30, kind="dropped", **FRONT)
    assert [frame.time_ns // 2_000_000 for frame in passed] == [*range(10), *range(20, 30)]
    assert counters.good + counters.wrong_sequence == 20


def test_dropped_frames_are_picked_by_probability():
    passed, _ = frames_under(1000, kind="dropped", target="WheelSpeedsFront", probability=0.3)
    assert len(passed) == pytest.approx(700, abs=45)


def test_duplicated_frames_are_seen_as_repeated():
    _, counters = frames_under(30, kind="duplicated", **FRONT)
    assert (counters.good, counters.repeated) == (30, 10)


@pytest.mark.parametrize("kind", ["bit-flip", "wrong-crc"])
def test_damaged_frames_fail_their_check(kind):
    _, counters = frames_under(30, kind=kind, **FRONT)
    assert counters.e2e_error == 10


def test_a_chosen_bit_flips():
    good, _ = frames_under(1, kind="dropped", **FRONT)
    bad, _ = frames_under(1, kind="bit-flip", target="WheelSpeedsFront", bit=17)
    assert bad[0].data[2] == good[0].data[2] ^ 0b10


def test_a_frozen_counter_is_signed_correctly_and_seen_as_repeated():
    passed, counters = frames_under(30, kind="frozen-counter", **FRONT)
    assert len({frame.data[1] & 15 for frame in passed[9:20]}) == 1
    assert (counters.repeated, counters.e2e_error) == (10, 0)


def test_delayed_frames_are_offered_late():
    passed, _ = frames_under(11, kind="delayed", delay_s=0.005, **FRONT)
    assert passed[10].time_ns == 20_000_000 + 5_000_000


def test_an_intermittent_message_comes_and_goes():
    passed, _ = frames_under(20, kind="intermittent", target="WheelSpeedsFront", period_s=0.008)
    assert [frame.time_ns // 2_000_000 % 4 for frame in passed] == [2, 3] * 5


def test_bus_off_silences_only_its_node():
    fault = Fault(target="TCS", kind="bus-off")
    faults = FrameFaults((fault,), DATABASE, np.random.default_rng(0))
    frame = TimedFrame(0, 0x90, bytes(6))
    assert faults.pass_on(frame, Sender.SERVICE) == []
    assert faults.pass_on(frame, Sender.VEHICLE) == [frame]
    assert not faults.deaf(0.0)


def test_a_vehicle_that_is_off_the_bus_is_deaf_too():
    fault = Fault(target="VEHICLE", kind="bus-off", start_s=1.0, end_s=2.0)
    faults = FrameFaults((fault,), DATABASE, np.random.default_rng(0))
    assert [faults.deaf(time) for time in (0.5, 1.5, 2.5)] == [False, True, False]


def test_a_babbling_node_adds_frames_at_its_period():
    fault = Fault(target="VEHICLE", kind="babbling", start_s=0.001, period_s=0.0005, frame_id=3)
    faults = FrameFaults((fault,), DATABASE, np.random.default_rng(0))
    babble = [*faults.babble(0, 1_700_000), *faults.babble(1_700_000, 3_000_000)]
    assert [frame.time_ns for frame in babble] == [1_000_000, 1_500_000, 2_000_000, 2_500_000]
    assert {frame.frame_id for frame in babble} == {3}


def listing(drive, signals, fault):
    plant = drive([[0.0, 60.0]], fault=fault, start_speed_kmph=20.0, **signals)
    plant.step(None, 0.1)
    return plant


def test_a_signal_that_is_off_is_invalid_where_it_can_be(drive):
    names = ("WheelSpeedRL", "MotorSpeedL", "DriverTorqueRequestR", "VehicleAccelX")
    read = listing(drive, {}, [{"target": name, "kind": "off"} for name in names]).signals()
    assert read.wheel_speed_valid == (True, True, False, True)
    assert read.wheel_speed_radps[2] == read.motor_speed_radps[0] == read.driver_torque_nm[1] == 0.0
    assert read.accel_x_mps2 is None
    assert read.driver_torque_nm[0] == 60.0


def test_two_faults_on_one_signal_act_in_order(drive):
    faults = [
        {"target": "DriverTorqueRequestL", "kind": "wrong", "offset": 10.0},
        {"target": "DriverTorqueRequestL", "kind": "wrong", "scale": 2.0},
    ]
    assert listing(drive, {}, faults).signals().driver_torque_nm == (140.0, 60.0)


def test_a_missing_tooth_comes_and_goes(drive):
    fault = {"target": "WheelSpeedFL", "kind": "tooth-missing", "start_s": 0.5, "end_s": 1.5}
    plant = drive(fault=[fault], sensors={"pitch_error_ratio": 0.0}, start_speed_kmph=30.0)
    ripple = []
    for _ in range(4):
        shown = []
        for _ in range(250):
            plant.step(None, 0.002)
            shown.append(plant.signals().wheel_speed_radps[0] / plant.truth.wheel_speed_radps[0])
        ripple.append(max(shown) - min(shown))
    assert ripple[0] < 0.02
    assert min(ripple[1:3]) > 0.1


@pytest.mark.parametrize(
    ("fault", "expected"),
    [
        ({"kind": "wrong", "scale": 0.5}, TorqueLimits(30.0, 60.0)),
        ({"kind": "off"}, TorqueLimits(NO_LIMIT, 60.0)),
        ({"kind": "garbage", "low": 7.0, "high": 7.0}, TorqueLimits(7.0, 60.0)),
    ],
)
def test_a_torque_limit_can_be_spoilt_on_its_way_in(fault, expected):
    faults = LimitFaults(
        (Fault(target="TorqueLimitL", start_s=1.0, **fault),), np.random.default_rng(0)
    )
    assert faults.apply(TorqueLimits(60.0, 60.0), 0.5) == TorqueLimits(60.0, 60.0)
    assert faults.apply(TorqueLimits(60.0, 60.0), 1.5) == expected


def test_no_limit_survives_a_slow_limit_signal():
    faults = LimitFaults((Fault(target="TorqueLimitR", kind="slow"),), np.random.default_rng(0))
    for _ in range(3):
        assert faults.apply(TorqueLimits(), 0.1) == TorqueLimits()
