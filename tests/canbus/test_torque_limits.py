"""Torque limits from the service to the motors."""

from __future__ import annotations

import math

import pytest
from factories import command
from hypothesis import given
from hypothesis import strategies as st

from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.canbus.vehicle_node import VehicleNode
from tcs_hil.signals import NO_LIMIT, TorqueLimits

DATABASE = load_database()


def limits_through_the_bus(limits):
    service, vehicle = TcsNode(DATABASE), VehicleNode(DATABASE)
    for frame in service.frames(command(*limits), 0):
        assert vehicle.feed(*frame, 7)
    assert vehicle.limits_stamp_ns == 7
    return vehicle.limits


@given(st.floats(0.0, 819.0), st.floats(0.0, 819.0))
def test_a_finite_limit_arrives_within_half_a_step(left_nm, right_nm):
    arrived = limits_through_the_bus(TorqueLimits(left_nm, right_nm))
    assert arrived == pytest.approx((left_nm, right_nm), abs=0.0250001)


def test_no_limit_arrives_as_no_limit():
    assert limits_through_the_bus(TorqueLimits(NO_LIMIT, 0.0)) == TorqueLimits(NO_LIMIT, 0.0)


def test_a_finite_limit_never_turns_into_no_limit():
    arrived = limits_through_the_bus(TorqueLimits(1e9, 819.15))
    assert arrived == pytest.approx((819.1, 819.1))


def test_a_limit_that_is_not_a_number_holds_nothing_back():
    assert limits_through_the_bus(TorqueLimits(math.nan, 10.0)).left_nm == NO_LIMIT
