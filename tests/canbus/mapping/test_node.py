"""What a mapped node makes of good frames, bad ones, strangers and silence."""

from __future__ import annotations

import math
import tomllib

import pytest
from factories import command, measurement
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from tcs_hil.config import convert
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.runtime.seams import Node
from tcs_hil.service.bus_end import bus_end
from tcs_hil.service.settings import ServiceConfig
from tcs_hil.signals import BusCondition, InputState

from .makers import AURELIS, GRAVITY_MPS2, KMPH, MAKERS, MONTANE, QUENDAL, Car, Maker
from .mapped import node_of

MS = 1_000_000
PERIOD_NS = 2 * MS
SEEN = measurement(accel_x_mps2=1.0)


def live(node: Node, maker: Maker, ticks: int = 20) -> Car:
    """A car that has talked to the node for some ticks, the last one just now."""
    car = Car(maker)
    for tick in range(ticks):
        for frame_id, data in car.frames(SEEN):
            assert node.feed(frame_id, data, tick * PERIOD_NS)
    return car


@pytest.mark.parametrize("maker", MAKERS, ids=lambda maker: maker.name)
def test_before_the_first_frame_nothing_is_known(maker: Maker) -> None:
    seen = node_of(maker).measurement(0)
    assert seen.wheel_speed_valid == (False,) * 4
    assert seen.front_speed_age_s == seen.rear_speed_age_s == seen.driver_age_s == math.inf
    assert seen.front_speed_state is seen.driver_state is InputState.NO_DATA
    assert math.isnan(seen.accel_x_mps2)


def test_motors_the_bus_does_not_have_are_absent_not_late() -> None:
    node = node_of(QUENDAL)
    live(node, QUENDAL)
    assert node.measurement(0).motor_state is InputState.ABSENT
    assert node_of(MONTANE).measurement(0).motor_state is InputState.NO_DATA


BARE = {name: {"cycle_ms": 2} for name in ("WHL_DATA", "DRV_REQ")} | {
    "TCU_LIM": {"cycle_ms": 2, "fixed": {"TCU_Page": 1}}
}
"""Quendal's messages without their counters."""


def test_any_payload_of_a_multiplexed_message_reads_as_cantools_reads_it() -> None:
    node, message = node_of(QUENDAL, messages=BARE), QUENDAL.dbc().get_message_by_name("WHL_DATA")
    pages = {1: (slice(0, 2), ("WHL_VL", "WHL_VR")), 2: (slice(2, 4), ("WHL_HL", "WHL_HR"))}

    @given(payload=st.binary(min_size=7, max_size=7))
    def check(payload: bytes) -> None:
        before = node.measurement(0).wheel_speed_radps
        assert node.feed(message.frame_id, payload, 0)
        after = node.measurement(0).wheel_speed_radps
        page = payload[0] & 7
        if page not in pages:
            assert after == before
            return
        wheels, names = pages[page]
        values = message.decode(payload)
        assert after[wheels] == pytest.approx([values[name] / KMPH for name in names])

    check()


def test_any_payload_of_motorola_bits_with_a_sign_reads_as_cantools_reads_it() -> None:
    node, message = node_of(MONTANE), MONTANE.dbc().get_message_by_name("ABS_LongAcc")

    @given(payload=st.binary(min_size=4, max_size=4))
    def check(payload: bytes) -> None:
        assert node.feed(message.frame_id, payload, 0)
        values = message.decode(payload)
        seen = node.measurement(0).accel_x_mps2
        if values["LongAcc_Q"] == 1:
            assert seen == pytest.approx(values["LongAcc"] * GRAVITY_MPS2)
        else:
            assert math.isnan(seen)

    check()


def test_a_request_that_is_marked_invalid_counts_as_not_received() -> None:
    node = node_of(QUENDAL, messages=BARE)
    dbc = QUENDAL.dbc().get_message_by_name("DRV_REQ")

    def request(percent: float) -> bytes:
        values = {"DRV_PedL": percent, "DRV_PedR": 20.0, "DRV_Cnt0": 0, "DRV_Cnt123": 0}
        return bytes(dbc.encode(values))

    node.feed(dbc.frame_id, request(50.0), 0)
    node.feed(dbc.frame_id, request(104.0), 10 * MS)  # beyond valid_range
    seen = node.measurement(10 * MS)
    assert seen.driver_torque_nm == pytest.approx((130.0, 52.0))
    assert seen.driver_age_s == pytest.approx(0.010)  # as old as the older of the two


def test_an_acceleration_that_stays_away_is_none() -> None:
    node = node_of(MONTANE)
    car = live(node, MONTANE)
    assert node.measurement(19 * PERIOD_NS).accel_x_mps2 == pytest.approx(1.0, abs=0.005)
    for tick in range(20, 24):
        for frame_id, data in car.frames(SEEN):
            if frame_id != 304:
                node.feed(frame_id, data, tick * PERIOD_NS)
    seen = node.measurement(23 * PERIOD_NS)
    assert math.isnan(seen.accel_x_mps2)
    assert seen.front_speed_age_s == 0.0


def test_damaged_repeated_and_foreign_frames_are_counted_and_change_nothing() -> None:
    node = node_of(AURELIS)
    car = live(node, AURELIS)
    before = node.measurement(19 * PERIOD_NS)
    frames = dict(car.frames(replace(SEEN, wheel_speed_radps=(99.0,) * 4)))
    damaged = bytearray(frames[64])
    damaged[3] ^= 1
    assert not node.feed(64, bytes(damaged), 19 * PERIOD_NS)
    assert not node.feed(64, frames[64][:5], 19 * PERIOD_NS)
    assert not node.feed(0x123, b"stranger", 19 * PERIOD_NS)
    assert node.measurement(19 * PERIOD_NS) == before
    assert node.feed(65, frames[65], 19 * PERIOD_NS)
    assert not node.feed(65, frames[65], 19 * PERIOD_NS)
    counters = node.counters
    assert (counters.e2e_error, counters.wrong_length, counters.unknown_id) == (1, 1, 1)
    assert counters.repeated == 1


def test_damage_that_lasts_makes_the_input_invalid() -> None:
    node = node_of(AURELIS)
    live(node, AURELIS)
    for tick in range(20, 40):
        node.feed(64, bytes(6), tick * PERIOD_NS)
    seen = node.measurement(39 * PERIOD_NS)
    assert seen.front_speed_state is InputState.INVALID


def test_our_own_identifier_from_somebody_else_is_an_intruder() -> None:
    node = node_of(MONTANE)
    node.feed(352, bytes(6), 0)
    assert node.measurement(0).bus is BusCondition.INTRUDER
    assert node.measurement(0).bus is BusCondition.OK


def test_limits_keep_the_cycle_of_their_message() -> None:
    limits = tomllib.loads(MONTANE.toml.read_text())["map"]["messages"] | {
        "TCS_TrqLim": {"cycle_ms": 10}
    }
    node = node_of(MONTANE, messages=limits)
    sent = [tick for tick in range(20) if node.frames(command(1.0, 2.0), tick * PERIOD_NS)]
    assert sent == [0, 5, 10, 15]


@pytest.mark.parametrize(
    ("limits", "wheel_nm"),
    [((40.0, 55.0), 240.0), ((math.inf, 30.0), 180.0), ((math.inf, math.inf), 3000.0)],
)
def test_one_limit_of_the_axle_is_twice_the_lower_one(
    limits: tuple[float, float], wheel_nm: float
) -> None:
    node = node_of(
        AURELIS,
        limits={
            "axle": {"signal": "TrcLimit.TrcLe_M", "at": "wheel"},
            "active": {"signal": "TrcLimit.TrcRi_Act"},
        },
    )
    ((_, data),) = node.frames(command(*limits), 0)
    values = AURELIS.dbc().get_message_by_name("TrcLimit").decode(data)
    assert values["TrcLe_M"] == pytest.approx(wheel_nm, abs=0.05)
    assert values["TrcRi_Act"] == (min(limits) < math.inf)


@pytest.mark.parametrize(
    ("limit_nm", "said_nm"), [(math.nan, 923.75), (1e9, 900.0), (-1e9, -100.0), (0.0, 0.0)]
)
def test_any_number_goes_out_as_a_torque_or_as_no_limit(limit_nm: float, said_nm: float) -> None:
    ((_, data),) = node_of(MONTANE).frames(command(limit_nm, 0.0), 0)
    values = MONTANE.dbc().get_message_by_name("TCS_TrqLim").decode(data)
    assert values["TCS_LimL"] == said_nm


def test_the_believed_car_sets_radius_gear_and_full_torque() -> None:
    config = tomllib.loads(QUENDAL.toml.read_text()) | {"vehicle": {"wheel_radius_m": 0.636}}
    node = bus_end(convert(config, ServiceConfig, "test").beside(QUENDAL.toml.parent)).node
    live(node, QUENDAL)
    half = Vehicle().wheel_radius_m / 0.636
    assert node.measurement(0).wheel_speed_radps[0] == pytest.approx(20.0 * half, abs=0.01)
