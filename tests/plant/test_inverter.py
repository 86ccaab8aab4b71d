"""The motor side obeys limits, holds them for 10 ms and then lets go gently."""

import math

import pytest

from plant_emulator.inverter import demanded
from plant_emulator.limit_keeper import LimitKeeper
from plant_emulator.pedal import Line
from tcs_hil.signals import TorqueLimits

FULL = Line(250.0, 0.0)


@pytest.fixture
def keeper():
    keeper = LimitKeeper()
    keeper.accept(TorqueLimits(100.0, 50.0), time_s=1.0)
    return keeper


def torque_at(keeper, time_s, request=FULL):
    return demanded(keeper.demand(request, time_s), 0.0)


def test_without_limits_the_motors_follow_the_driver():
    assert torque_at(LimitKeeper(), 5.0) == (250.0, 250.0)


def test_the_lower_of_request_and_limit_wins(keeper):
    assert torque_at(keeper, 1.005) == (100.0, 50.0)
    assert torque_at(keeper, 1.005, Line(70.0, 0.0)) == (70.0, 50.0)


def test_limits_hold_for_10_ms_and_then_rise_by_500_nm_per_s(keeper):
    assert keeper.next_change(1.0) == pytest.approx(1.01)
    assert torque_at(keeper, 1.0099) == (100.0, 50.0)
    assert torque_at(keeper, 1.11) == pytest.approx((150.0, 100.0))
    assert torque_at(keeper, 2.0) == (250.0, 250.0)


def test_a_demand_is_the_same_line_however_it_is_cut(keeper):
    early = keeper.demand(FULL, 1.01)
    assert demanded(early, 0.04) == pytest.approx(torque_at(keeper, 1.05))


def test_fresh_limits_end_the_release(keeper):
    keeper.accept(TorqueLimits(30.0, 30.0), time_s=1.2)
    assert torque_at(keeper, 1.2) == (30.0, 30.0)


def test_no_limit_never_expires():
    keeper = LimitKeeper()
    keeper.accept(TorqueLimits(), 1.0)
    assert keeper.next_change(1.0) == math.inf
    assert torque_at(keeper, 3.0) == (250.0, 250.0)


def test_one_sided_no_limit_stays_no_limit():
    keeper = LimitKeeper()
    keeper.accept(TorqueLimits(left_nm=40.0), 1.0)
    assert torque_at(keeper, 1.02) == pytest.approx((45.0, 250.0))
