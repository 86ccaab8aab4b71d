"""What a port meets becomes one condition: the worst, for a tick or until it is mended."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tcs_hil.canbus.health import BusHealth
from tcs_hil.signals import BusCondition

OK = BusCondition.OK
PASSIVE = (0x004, b"\x00\x20")
ACTIVE = (0x004, b"\x00\x40")
BUS_OFF = (0x040, bytes(8))
RESTARTED = (0x100, bytes(8))


@pytest.fixture
def health() -> BusHealth:
    return BusHealth()


def conditions(health: BusHealth, ticks: int) -> list[BusCondition]:
    return [health.condition() for _ in range(ticks)]


@pytest.mark.parametrize(
    ("happen", "condition"),
    [
        (BusHealth.overflowed, BusCondition.OVERFLOW),
        (BusHealth.send_failed, BusCondition.SEND_FAILED),
        (lambda h: h.error_frame(0x004, b"\x00\x01"), BusCondition.OVERFLOW),
    ],
)
def test_what_is_over_is_said_once(
    health: BusHealth, happen: Callable[[BusHealth], None], condition: BusCondition
) -> None:
    happen(health)
    assert conditions(health, 2) == [condition, OK]


def test_the_worst_of_a_tick_is_said(health: BusHealth) -> None:
    health.send_failed()
    health.overflowed()
    assert health.condition() is BusCondition.SEND_FAILED


def test_a_lost_link_lasts_until_a_frame_could_be_sent(health: BusHealth) -> None:
    health.link_lost()
    health.heard()  # it may have been waiting since before
    assert conditions(health, 3) == [BusCondition.DOWN] * 3
    health.sent()
    assert health.condition() is OK


def test_a_link_that_was_lost_for_less_than_a_tick_is_said(health: BusHealth) -> None:
    health.link_lost()
    health.sent()
    assert conditions(health, 2) == [BusCondition.DOWN, OK]


@pytest.mark.parametrize("end", [RESTARTED, ACTIVE])
def test_bus_off_lasts_until_the_controller_is_back(
    health: BusHealth, end: tuple[int, bytes]
) -> None:
    health.error_frame(*BUS_OFF)
    health.sent()  # the driver's queue takes frames that the wire never sees
    assert conditions(health, 3) == [BusCondition.BUS_OFF] * 3
    health.error_frame(*end)
    assert health.condition() is OK


def test_a_frame_that_is_heard_ends_bus_off(health: BusHealth) -> None:
    health.error_frame(*BUS_OFF)
    health.heard()
    assert conditions(health, 2) == [BusCondition.BUS_OFF, OK]


def test_a_passive_controller_hears_frames_and_stays_passive(health: BusHealth) -> None:
    health.error_frame(*PASSIVE)
    health.heard()
    health.sent()
    assert conditions(health, 2) == [BusCondition.ERROR_PASSIVE] * 2
    health.error_frame(*ACTIVE)
    assert health.condition() is OK


def test_an_interface_taken_down_and_up_begins_with_a_fresh_controller(health: BusHealth) -> None:
    health.error_frame(*BUS_OFF)
    health.link_lost()
    assert health.condition() is BusCondition.BUS_OFF  # the worst of the tick
    health.sent()
    assert health.condition() is OK
