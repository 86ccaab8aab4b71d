"""The driver's points are straight lines."""

import math

import pytest

from plant_emulator.driver import Driver
from plant_emulator.pedal import Pedal


@pytest.fixture
def pedal():
    return Pedal(Driver(request=((0.1, 0.0), (0.6, 250.0), (1.0, 250.0), (1.0, 50.0))))


@pytest.mark.parametrize(
    ("time_s", "value", "slope"),
    [
        (0.0, 0.0, 0.0),
        (0.1, 0.0, 500.0),
        (0.35, 125.0, 500.0),
        (0.6, 250.0, 0.0),
        (1.0, 50.0, 0.0),
        (9.0, 50.0, 0.0),
    ],
)
def test_the_request_follows_the_points(pedal, time_s, value, slope):
    line = pedal.at(time_s)
    assert (line.value, line.slope) == pytest.approx((value, slope))


@pytest.mark.parametrize(
    ("time_s", "change_s"), [(0.0, 0.1), (0.1, 0.6), (0.7, 1.0), (1.0, math.inf)]
)
def test_the_next_corner_is_known(pedal, time_s, change_s):
    assert pedal.next_change(time_s) == change_s
