"""Bytes on three makers' wires, worked out by hand from the layouts in tests/data/dbc.

A codec that is wrong both ways would cancel in tests that go there and back.
Raw values and their bits stand beside each payload; sums and exclusive-ors can
be checked in the head, the CRCs come from the bitwise algorithm of ``makers``.
"""

from __future__ import annotations

import math

import pytest

from tcs_hil.signals import (
    NO_LIMIT,
    Command,
    ControllerKind,
    Measurement,
    TcsState,
    TorqueLimits,
)

from .makers import AURELIS, MONTANE, QUENDAL, Maker, crc8
from .mapped import node_of

KMPH = 1.0 / 3.6 / 0.318  # rad/s of a wheel of 318 mm
RPM = 2.0 * math.pi / 60.0
COMMAND = Command(
    limits=TorqueLimits(40.0, NO_LIMIT),
    active=(True, False),
    state=TcsState.ACTIVE,
    fault_code=0,
    controller=ControllerKind.NMPC,
    slip_ratio=(0.1, 0.1),
    slip_reference=0.1,
)


def heard(maker: Maker, *frames: tuple[int, str]) -> Measurement:
    node = node_of(maker)
    for frame_id, payload in frames:
        assert node.feed(frame_id, bytes.fromhex(payload), 0)
    return node.measurement(0)


def test_motorola_speeds_with_an_offset_under_an_exclusive_or() -> None:
    # FL raw 3000 and FR raw 4000, high byte first; FR's status 1 in bits 5..4 of byte 4; count 5.
    # 0b ^ b8 ^ 0f ^ a0 ^ 10 ^ 00 ^ 05 = 09
    seen = heard(MONTANE, (288, "0b b8 0f a0 10 00 05 09"))
    assert seen.wheel_speed_radps[:2] == pytest.approx((10.0 * KMPH, 20.0 * KMPH))
    assert seen.wheel_speed_valid[:2] == (True, False)


def test_intel_motors_under_a_complemented_sum_the_right_one_turned_round() -> None:
    # Count 3; speeds raw 2600 and 1400 (offset -2000) at 12 and 26, torques 400 and -400 at 40, 52.
    # 6e + 83 + a2 + e0 + 15 + 90 + 01 + e7 = 400
    seen = heard(MONTANE, (320, "6e 83 a2 e0 15 90 01 e7"))
    assert seen.motor_speed_radps == pytest.approx((600.0 * RPM, 600.0 * RPM))
    assert seen.motor_torque_nm == pytest.approx((100.0, 100.0))


def test_one_torque_of_the_axle_at_the_wheels_is_halved_and_geared() -> None:
    # Raw 2400 is 1200 Nm; count 7. 09 + 60 + 07 = 70, inverted 8f
    seen = heard(MONTANE, (336, "09 60 07 8f"))
    assert seen.driver_torque_nm == pytest.approx((200.0, 200.0))


def test_a_page_with_a_split_counter_and_an_invalid_code() -> None:
    # Page 1 at 0; count 6 as 2 at bit 3 and 1 at bit 54; raw 1000 at 8, 32767 (invalid) at 23.
    seen = heard(QUENDAL, (196, "11 e8 83 ff 3f 00 40"))
    assert seen.wheel_speed_radps[0] == pytest.approx(7.5 * KMPH)
    assert seen.wheel_speed_valid == (True, False, False, False)


def test_profile_1_speeds_in_rpm() -> None:
    # Count 4, raw 2000 and 3000; then count 9, raw 2000 and 65535 (invalid).
    front, rear = bytes.fromhex("be 04 d0 07 b8 0b"), bytes.fromhex("80 09 d0 07 ff ff")
    assert front[0] == crc8(0x1D, b"\x40\x01" + front[1:], initial=0, final_xor=0)
    assert rear[0] == crc8(0x1D, b"\x41" + rear[1:], initial=0, final_xor=0)
    seen = heard(AURELIS, (64, front.hex()), (65, rear.hex()))
    assert seen.wheel_speed_radps[:3] == pytest.approx((100.0 * RPM, 150.0 * RPM, 100.0 * RPM))
    assert seen.wheel_speed_valid == (True, True, True, False)


def test_a_crc_at_the_end_of_the_frame_over_two_bytes_of_data_id() -> None:
    # Count 2 at 0; speeds raw 1500 and 1000 at 4 and 18; torques 500 and -35 at 32 and 44.
    motor = bytes.fromhex("c2 5d a0 0f f4 d1 fd d4")
    assert motor[7] == crc8(0x2F, motor[:7] + b"\x50\x3c")
    seen = heard(AURELIS, (80, motor.hex()))
    assert seen.motor_speed_radps == pytest.approx((250.0 * RPM, 0.0))
    assert seen.motor_torque_nm == pytest.approx((100.0, -7.0))


def test_profile_2_demands_at_the_wheel() -> None:
    # Count 1, whose data id is c2; raw 3000 and 1500.
    demand = bytes.fromhex("66 01 b8 0b dc 05")
    assert demand[0] == crc8(0x2F, demand[1:] + b"\xc2")
    seen = heard(AURELIS, (81, demand.hex()))
    assert seen.driver_torque_nm == pytest.approx((100.0, 50.0))


@pytest.mark.parametrize(
    ("maker", "frame_id", "payload"),
    [
        # Active at bits 6 and 7 of byte 0; raw 560 and 4095; mode 2; count 1.
        # 42 + 30 + 2f + ff + 01 = 1a1
        (MONTANE, 352, "42 30 2f ff 01 a1"),
        # Page 1; count 1 at bit 2; 15.385 % is raw 513 at 4, 4095 at 16; intervening: 2 at 32.
        (QUENDAL, 234, "15 20 ff 0f 02"),
        # Data id's nibble 2 and count 1; left active; raw 11200 (120 Nm) and 40000 (3000 Nm).
        (AURELIS, 96, "8a 21 01 c0 2b 40 9c 00"),
    ],
    ids=lambda value: value.name if isinstance(value, Maker) else "",
)
def test_the_limits_on_every_wire(maker: Maker, frame_id: int, payload: str) -> None:
    assert node_of(maker).frames(COMMAND, 0) == [(frame_id, bytes.fromhex(payload))]
