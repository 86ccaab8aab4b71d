"""Bytes on the wire, worked out by hand from the layout in dbc/tcs.dbc.

Both processes share one codec, so a symmetric bug would cancel in every test
that only goes there and back.  Nothing here but the nodes is product code: the
payloads are written down from raw values and bit positions, the CRC comes from
the bitwise algorithm below.
"""

from __future__ import annotations

import pytest

from tcs_hil.canbus.bench_control import AS_IN_SCENARIO, BenchControl, BenchFault
from tcs_hil.canbus.bench_node import BenchInbox, BenchNode
from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.canbus.vehicle_node import VehicleNode, VehicleSignals
from tcs_hil.signals import NO_LIMIT, Command, ControllerKind, RoadEstimate, TcsState, TorqueLimits

DATA_IDS = {
    0x090: "9017A33C5D0EE4718B26F1486AD5B20F",
    0x098: "98C25117E90B7D3486F04FAA2DB8136E",
    0x0A0: "A05B19D4723EC80756FD9361B48E2CEA",
    0x0A1: "A16D38F2049BC75E83D01A4CE72965BF",
    0x0A2: "A24FE3087C95D61B32A95E80C4176DFA",
    0x7F2: "F21D84B65FC03A977B2E0CE148D36AA9",
}

# Counter 1 and 2 in the low nibble of byte 1; all payload bits from bit 12 on, Intel order.
GOLDEN = {
    # limits raw 2000 at bit 16 and 16383 at bit 30; left active at 12; state 3 at 44
    0x090: ("93 11 d0 c7 ff 3f", "ed 12 d0 c7 ff 3f"),
    # raw 2000 at bit 16, 1000 at bit 28
    0x098: ("de 01 d0 87 3e", "3a 02 d0 87 3e"),
    # speeds raw 4000 and 1000 (offset -100) at 12 and 27, torques 1600 and 580 at 42 and 53
    0x0A0: ("84 01 fa 40 1f 00 99 48", "90 02 fa 40 1f 00 99 48"),
    # FL valid at 12, FR not; raw 1234 at 16, 65535 at 32
    0x0A1: ("81 11 d2 04 ff ff", "a6 12 d2 04 ff ff"),
    # all three valid at 12, 13, 14; raw 1234, 1, and -1500 in two's complement at 48
    0x0A2: ("91 71 d2 04 01 00 24 fa", "46 72 d2 04 01 00 24 fa"),
}
# slips raw -200 and 250 at 0 and 12, reference 200 at 24, KMPC at 34, fault 7, 513 overruns
GOLDEN_STATUS = "38 af 0f c8 08 07 01 02"
# mu raw 300 at 0 and 1050 at 11, confidence 100 at 22 and 7 at 29, delay 586 at 36
GOLDEN_ESTIMATES = "2c d1 20 f9 a0 24"
# fault 3 at bit 12, throttle raw 960 at 16, mu raw 300 at 28; then both overrides absent
GOLDEN_CONTROLS = {
    "31 c0 c3 12": BenchControl(120.0, 0.3, BenchFault.WHEEL_SPEEDS_REAR_DROPPED),
    "02 ff ff 7f": AS_IN_SCENARIO,
}

SIGNALS = VehicleSignals(
    wheel_speed_radps=(12.34, 655.35, 12.34, 0.01),
    wheel_speed_valid=(True, False, True, True),
    motor_speed_radps=(100.0, -50.0),
    motor_torque_nm=(250.0, -5.0),
    driver_torque_nm=(250.0, 125.0),
    accel_x_mps2=-1.5,
)
COMMAND = Command(
    limits=TorqueLimits(100.0, NO_LIMIT),
    active=(True, False),
    state=TcsState.ACTIVE,
    fault_code=7,
    controller=ControllerKind.KMPC,
    slip_ratio=(-0.1, 0.125),
    slip_reference=0.1,
    road=RoadEstimate((0.3, 1.05), (1.0, 0.07), 0.00586),
)


def crc8h2f(data: bytes) -> int:
    """CRC-8 with polynomial 0x2F, start 0xFF, inverted (AUTOSAR SWS CRC Library)."""
    crc = 0xFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = (crc << 1 ^ 0x2F if crc & 0x80 else crc << 1) & 0xFF
    return crc ^ 0xFF


def test_the_crc_of_this_file_has_the_check_value_of_the_standard():
    assert crc8h2f(b"123456789") == 0xDF


@pytest.mark.parametrize("frame_id", GOLDEN)
@pytest.mark.parametrize("counter", [1, 2])
def test_the_golden_bytes_carry_the_profile_2_crc(frame_id, counter):
    payload = bytes.fromhex(GOLDEN[frame_id][counter - 1])
    data_id = bytes.fromhex(DATA_IDS[frame_id])[counter]
    assert payload[1] & 0x0F == counter
    assert payload[0] == crc8h2f(payload[1:] + bytes([data_id]))


@pytest.mark.parametrize("counter", [1, 2])
def test_the_vehicle_sends_the_golden_bytes(counter):
    node = VehicleNode(load_database())
    for tick in range(counter):
        frames = node.frames(SIGNALS, tick * 10_000_000)
    expected = {i: bytes.fromhex(g[counter - 1]) for i, g in GOLDEN.items() if i != 0x090}
    assert dict(frames) == expected


@pytest.mark.parametrize("counter", [1, 2])
def test_the_service_sends_the_golden_bytes(counter):
    node = TcsNode(load_database())
    for tick in range(counter):
        frames = node.frames(COMMAND, tick * 20_000_000, tick_overruns=513)
    expected = [(0x300, GOLDEN_STATUS), (0x090, GOLDEN[0x090][counter - 1])]
    assert frames == [(frame_id, bytes.fromhex(text)) for frame_id, text in expected]


def test_the_service_tells_its_estimates_in_a_tick_of_their_own():
    node = TcsNode(load_database())
    sent = [node.frames(COMMAND, tick * 2_000_000)[0] for tick in range(20)]
    estimates = (0x301, bytes.fromhex(GOLDEN_ESTIMATES))
    assert [tick for tick, frame in enumerate(sent) if frame == estimates] == [1, 11]
    assert [tick for tick, (frame_id, _) in enumerate(sent) if frame_id == 0x300] == [0, 10]


def test_the_service_reads_the_golden_bytes():
    node = TcsNode(load_database())
    for frame_id in (0x098, 0x0A0, 0x0A1, 0x0A2):
        assert node.feed(frame_id, bytes.fromhex(GOLDEN[frame_id][0]), 0)
    seen = node.measurement(0)
    assert seen.wheel_speed_radps == pytest.approx(SIGNALS.wheel_speed_radps)
    assert seen.wheel_speed_valid == SIGNALS.wheel_speed_valid
    assert seen.motor_speed_radps == pytest.approx(SIGNALS.motor_speed_radps)
    assert seen.motor_torque_nm == pytest.approx(SIGNALS.motor_torque_nm)
    assert seen.driver_torque_nm == pytest.approx(SIGNALS.driver_torque_nm)
    assert seen.accel_x_mps2 == pytest.approx(SIGNALS.accel_x_mps2)


def test_the_vehicle_reads_the_golden_bytes():
    node = VehicleNode(load_database())
    assert node.feed(0x090, bytes.fromhex(GOLDEN[0x090][0]), 0)
    assert node.feed(0x300, bytes.fromhex(GOLDEN_STATUS), 0)
    assert node.limits == TorqueLimits(100.0, NO_LIMIT)
    status = node.service
    assert (status.state, status.active) == (COMMAND.state, COMMAND.active)
    assert status.slip_ratio == pytest.approx(COMMAND.slip_ratio)
    assert status.slip_reference == pytest.approx(COMMAND.slip_reference)
    assert (status.controller, status.fault_code) == (ControllerKind.KMPC, 7)
    assert status.tick_overruns == 513
    assert node.feed(0x301, bytes.fromhex(GOLDEN_ESTIMATES), 0)
    assert node.road.friction_ratio == pytest.approx(COMMAND.road.friction_ratio)
    assert node.road.confidence_ratio == pytest.approx(COMMAND.road.confidence_ratio)
    assert node.road.loop_delay_s == pytest.approx(COMMAND.road.loop_delay_s)


@pytest.mark.parametrize(("tick", "payload"), [(1, "01 00 00 00"), (0x12345678, "78 56 34 12")])
def test_the_bench_ticks_are_plain_numbers_on_the_wire(tick, payload):
    vehicle, service = VehicleNode(load_database()), TcsNode(load_database())
    assert vehicle.bench_tick(tick) == (0x7F0, bytes.fromhex(payload))
    assert service.bench_tick_done(tick) == (0x7F1, bytes.fromhex(payload))


def golden_controls():
    """Payloads with the CRC of the standard, counter 1 and 2, and what they ask for."""
    ids = bytes.fromhex(DATA_IDS[0x7F2])
    for text, control in GOLDEN_CONTROLS.items():
        rest = bytes.fromhex(text)
        yield bytes([crc8h2f(rest + ids[(rest[0] & 0x0F) :][:1])]) + rest, control


def test_the_bench_sends_the_golden_controls():
    node = BenchNode(load_database())
    for payload, control in golden_controls():
        assert node.frame(control) == (0x7F2, payload)


def test_the_emulator_reads_the_golden_controls():
    inbox = BenchInbox(load_database())
    assert inbox.control == AS_IN_SCENARIO
    for payload, control in golden_controls():
        assert inbox.feed(payload, 0)
        assert inbox.control == control
