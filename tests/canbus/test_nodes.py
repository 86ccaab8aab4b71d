"""Service and vehicle as nodes: what they keep, what they count, when they speak."""

from __future__ import annotations

import math
from dataclasses import astuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.e2e import Protector
from tcs_hil.canbus.inbox import InboxCounters
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.canbus.vehicle_node import VehicleNode, VehicleSignals
from tcs_hil.signals import (
    NO_LIMIT,
    BusCondition,
    Command,
    ControllerKind,
    InputState,
    TcsState,
    TorqueLimits,
)

DATABASE = load_database()
MS = 1_000_000
TORQUE_LIMIT, DRIVER, MOTOR, FRONT, REAR, STATUS = 0x90, 0x98, 0xA0, 0xA1, 0xA2, 0x300

SIGNALS = VehicleSignals(
    wheel_speed_radps=(10.0, 11.0, 9.0, 9.5),
    wheel_speed_valid=(True, True, True, False),
    motor_speed_radps=(30.0, 33.0),
    motor_torque_nm=(100.0, 120.0),
    driver_torque_nm=(200.0, 210.0),
    accel_x_mps2=1.25,
)
COMMAND = Command(
    limits=TorqueLimits(150.0, NO_LIMIT),
    active=(True, False),
    state=TcsState.ACTIVE,
    fault_code=0,
    controller=ControllerKind.NMPC,
    slip_ratio=(0.1, 0.02),
    slip_reference=0.1,
)


@pytest.fixture
def service():
    return TcsNode(DATABASE)


@pytest.fixture
def vehicle():
    return VehicleNode(DATABASE)


def ids(frames):
    return [frame_id for frame_id, _ in frames]


def hand_over(frames, node, stamp_ns=0):
    return [node.feed(frame_id, data, stamp_ns) for frame_id, data in frames]


def test_before_the_first_frame_everything_is_invalid_and_infinitely_old(service):
    seen = service.measurement(0)
    assert seen.wheel_speed_valid == (False, False, False, False)
    assert math.isnan(seen.accel_x_mps2)
    ages = {seen.front_speed_age_s, seen.rear_speed_age_s, seen.motor_age_s, seen.driver_age_s}
    assert ages == {math.inf}
    assert service.newest_wheel_stamp_ns is None


def test_what_the_vehicle_sends_the_service_measures(service, vehicle):
    assert all(hand_over(vehicle.frames(SIGNALS, 0), service))
    seen = service.measurement(0)
    assert seen.wheel_speed_radps == pytest.approx(SIGNALS.wheel_speed_radps, abs=0.005)
    assert seen.wheel_speed_valid == SIGNALS.wheel_speed_valid
    assert seen.motor_speed_radps == pytest.approx(SIGNALS.motor_speed_radps, abs=0.025)
    assert seen.motor_torque_nm == pytest.approx(SIGNALS.motor_torque_nm, abs=0.125)
    assert seen.driver_torque_nm == pytest.approx(SIGNALS.driver_torque_nm, abs=0.0625)
    assert seen.accel_x_mps2 == pytest.approx(1.25, abs=0.0005)


def test_a_car_without_accelerometer_measures_nan(service, vehicle):
    hand_over(vehicle.frames(SIGNALS._replace(accel_x_mps2=None), 0), service)
    assert math.isnan(service.measurement(0).accel_x_mps2)


def test_each_source_has_its_own_age(service, vehicle):
    frames = dict(vehicle.frames(SIGNALS, 0))
    for stamp_ms, frame_id in enumerate((DRIVER, MOTOR, FRONT, REAR)):
        service.feed(frame_id, frames[frame_id], stamp_ms * MS)
    seen = service.measurement(10 * MS)
    assert seen.driver_age_s == pytest.approx(0.010)
    assert seen.motor_age_s == pytest.approx(0.009)
    assert seen.front_speed_age_s == pytest.approx(0.008)
    assert seen.rear_speed_age_s == pytest.approx(0.007)
    assert service.newest_wheel_stamp_ns == 3 * MS


def test_a_frame_stamped_after_the_tick_is_of_age_zero(service, vehicle):
    hand_over(vehicle.frames(SIGNALS, 0), service, stamp_ns=5)
    assert service.measurement(0).motor_age_s == 0.0


def states(seen):
    return (seen.front_speed_state, seen.rear_speed_state, seen.motor_state, seen.driver_state)


def test_each_message_has_its_own_state(service, vehicle):
    assert states(service.measurement(0)) == (InputState.NO_DATA,) * 4
    for tick in range(20):
        now_ns = tick * 2 * MS
        frames = vehicle.frames(SIGNALS, now_ns)
        hand_over([f for f in frames if tick < 8 or f[0] != MOTOR], service, now_ns)
        seen = service.measurement(now_ns)
    assert states(seen) == (InputState.VALID,) * 4
    for tick in range(20, 50):
        now_ns = tick * 2 * MS
        frames = vehicle.frames(SIGNALS, now_ns)
        hand_over([f for f in frames if f[0] in (FRONT, DRIVER)], service, now_ns)
        if tick >= 45:
            service.feed(REAR, b"short", now_ns)
        seen = service.measurement(now_ns)
    assert states(seen) == (
        InputState.VALID,
        InputState.INVALID,
        InputState.INVALID,
        InputState.VALID,
    )


def test_a_frame_of_the_wrong_length_is_an_error_of_its_message(service, vehicle):
    for tick in range(10):
        hand_over(vehicle.frames(SIGNALS, tick * 2 * MS), service, tick * 2 * MS)
    for tick in range(10, 21):
        assert service.measurement(tick * 2 * MS).motor_state is InputState.VALID
        assert not service.feed(MOTOR, b"", tick * 2 * MS)
    assert service.measurement(20 * 2 * MS).motor_state is InputState.INVALID


@pytest.mark.parametrize("counter", range(1, 16))
def test_a_vehicle_that_starts_anew_is_heard_with_its_second_frame_and_stays_valid(
    service, counter
):
    vehicle = VehicleNode(DATABASE)
    for tick in range(15 + counter):
        hand_over(vehicle.frames(SIGNALS, tick * 2 * MS), service, tick * 2 * MS)
    vehicle = VehicleNode(DATABASE)
    for tick in range(15 + counter, 60):
        now_ns = tick * 2 * MS
        good = hand_over(vehicle.frames(SIGNALS, now_ns), service, now_ns)
        assert all(good) or tick <= 15 + counter + 5  # the driver's second frame comes after 10 ms
        assert states(service.measurement(now_ns)) == (InputState.VALID,) * 4


def test_our_own_identifier_from_somebody_else_is_an_intruder_until_the_next_tick(service):
    assert service.measurement(0).bus is BusCondition.OK
    service.feed(TORQUE_LIMIT, bytes(6), 0)
    assert service.measurement(0).bus is BusCondition.INTRUDER
    assert service.measurement(0).bus is BusCondition.OK
    service.feed(STATUS, b"", 0)
    service.feed(STATUS, b"", 0)
    assert service.measurement(0, BusCondition.BUS_OFF).bus is BusCondition.INTRUDER


def test_what_the_port_has_seen_of_the_bus_is_passed_on(service):
    service.feed(0x123, b"", 0)
    assert service.measurement(0, BusCondition.DOWN).bus is BusCondition.DOWN


def test_every_bad_frame_is_counted_by_its_kind(service, vehicle):
    front = dict(vehicle.frames(SIGNALS, 0))[FRONT]
    assert service.feed(FRONT, front, 0)
    for frame_id, data in [
        (0x123, b""),
        (0x7FF, b""),
        (FRONT, front[:-1]),
        (FRONT, front + b"0"),
        (FRONT, bytes(6)),
        (FRONT, b"1" * 6),
        (FRONT, front),
        (FRONT, front),
        (FRONT, front),
        (TORQUE_LIMIT, bytes(6)),
        (STATUS, b""),
    ]:
        assert not service.feed(frame_id, data, 0)
    for first in (1, 13):
        for tick in range(first, first + 12):
            late = dict(vehicle.frames(SIGNALS, tick * 10 * MS))[FRONT]
        assert not service.feed(FRONT, late, 0)
    assert service.counters == InboxCounters(
        good=1,
        unknown_id=2,
        wrong_length=2,
        e2e_error=2,
        repeated=3,
        wrong_sequence=2,
        own_id=2,
    )


def test_a_bad_frame_changes_neither_value_nor_age(service, vehicle):
    hand_over(vehicle.frames(SIGNALS, 0), service)
    before = service.measurement(MS)
    assert not service.feed(FRONT, b"\xff" * 6, MS)
    assert service.measurement(MS) == before


@given(st.integers(0, 0x7FF), st.binary(max_size=8))
def test_no_frame_on_earth_makes_a_node_raise(frame_id, data):
    for node in (TcsNode(DATABASE), VehicleNode(DATABASE)):
        node.feed(frame_id, data, 0)
        assert sum(astuple(node.counters)) == 1


def test_the_torque_limits_go_out_every_tick_and_last(service):
    sent = [ids(service.frames(COMMAND, tick * 2 * MS)) for tick in range(21)]
    assert {frames[-1] for frames in sent} == {TORQUE_LIMIT}
    assert {len(frames) for frames in sent} == {1, 2}
    assert [tick for tick, frames in enumerate(sent) if STATUS in frames] == [0, 10, 20]


def test_the_vehicle_sends_on_its_cycles_in_ascending_order(vehicle):
    sent = [ids(vehicle.frames(SIGNALS, tick * 2 * MS)) for tick in range(6)]
    assert sent[0] == sent[5] == [DRIVER, MOTOR, FRONT, REAR]
    assert sent[1:5] == [[MOTOR, FRONT, REAR]] * 4


def test_jitter_of_the_sender_costs_no_cycle(vehicle):
    vehicle.frames(SIGNALS, 0)
    for tick, jitter_ns in enumerate((-400_000, 300_000, -500_000, 0), start=1):
        assert REAR in ids(vehicle.frames(SIGNALS, tick * 2 * MS + jitter_ns))


def test_between_two_cycles_nothing_is_sent(vehicle):
    vehicle.frames(SIGNALS, 0)
    assert vehicle.frames(SIGNALS, MS) == []


@pytest.mark.parametrize("pause_ms", [4, 100])
def test_after_a_pause_one_frame_is_sent_and_no_burst(vehicle, pause_ms):
    vehicle.frames(SIGNALS, 0)
    assert REAR in ids(vehicle.frames(SIGNALS, pause_ms * MS))
    assert vehicle.frames(SIGNALS, (pause_ms + 1) * MS) == []
    assert REAR in ids(vehicle.frames(SIGNALS, (pause_ms + 2) * MS))


def test_before_the_service_speaks_nothing_is_limited(vehicle):
    assert vehicle.limits == TorqueLimits(NO_LIMIT, NO_LIMIT)
    assert vehicle.limits_stamp_ns is None
    assert vehicle.service.state is TcsState.OFF


def test_numbers_outside_of_the_value_tables_read_as_fault_and_off(vehicle):
    limit, status = DATABASE.messages["TorqueLimit"], DATABASE.messages["TcsStatus"]
    payload = limit.codec.encode(0.0, 0.0, False, False, TcsState.ACTIVE)
    payload[5] |= 7 << 4  # TcsState at bit 44
    Protector(limit.e2e).protect(payload)
    assert vehicle.feed(TORQUE_LIMIT, bytes(payload), 0)
    payload = status.codec.encode(0.0, 0.0, 0.0, ControllerKind.NMPC, 0, 0)
    payload[4] |= 7 << 2  # TcsController at bit 34
    assert vehicle.feed(STATUS, bytes(payload), 0)
    assert vehicle.service.state is TcsState.FAULT
    assert vehicle.service.controller is ControllerKind.OFF


def test_bench_ticks_pass_in_both_directions(service, vehicle):
    assert (service.bench_tick, vehicle.bench_tick_done) == (None, None)
    assert service.feed(*vehicle.bench_tick(41), 0)
    assert service.bench_tick == 41
    assert vehicle.feed(*service.bench_tick_done(41), 0)
    assert vehicle.bench_tick_done == 41
