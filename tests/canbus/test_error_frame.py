"""SocketCAN's error frames, as the kernel's drivers write them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tcs_hil.canbus.error_frame import ErrorReport, read_error_frame
from tcs_hil.signals import BusCondition

OK, PASSIVE, BUS_OFF = BusCondition.OK, BusCondition.ERROR_PASSIVE, BusCondition.BUS_OFF


def said(error_class: int, data: str = "0000000000000000") -> ErrorReport:
    return read_error_frame(error_class, bytes.fromhex(data))


# Classes and bytes by hand from include/uapi/linux/can/error.h.
@pytest.mark.parametrize(
    ("error_class", "data", "controller"),
    [
        (0x004, "0004000000000000", OK),  # warning, from what was received
        (0x004, "0008000000000000", OK),  # warning, from what was sent
        (0x004, "0010000000000000", PASSIVE),
        (0x004, "0020000000000000", PASSIVE),
        (0x204, "0028000000008260", PASSIVE),  # one way passive, the other warning; with counts
        (0x004, "0040000000000000", OK),  # error-active again
        (0x040, "0000000000000000", BUS_OFF),
        (0x044, "0020000000000000", BUS_OFF),  # off the bus and, of course, passive before
        (0x100, "0000000000000000", OK),  # restarted
    ],
)
def test_the_state_of_the_controller_is_read(
    error_class: int, data: str, controller: BusCondition
) -> None:
    assert said(error_class, data) == ErrorReport(controller, OK)


@pytest.mark.parametrize(
    "error_class",
    [0x001, 0x002, 0x008, 0x010, 0x020, 0x080, 0x200],
    ids=["timeout", "arbitration", "protocol", "transceiver", "no-ack", "bus-error", "counts"],
)
def test_an_error_on_the_wire_says_nothing_about_the_state(error_class: int) -> None:
    assert said(error_class, "ffffffffffffffff") == ErrorReport(None, OK)


def test_a_controller_that_ran_full_has_lost_frames() -> None:
    assert said(0x004, "0001000000000000") == ErrorReport(None, BusCondition.OVERFLOW)


def test_a_controller_that_could_not_take_a_frame_has_not_sent_it() -> None:
    assert said(0x004, "0002000000000000") == ErrorReport(None, BusCondition.SEND_FAILED)


@given(st.integers(0, 0x1FFF_FFFF), st.binary(max_size=8))
def test_any_error_frame_can_be_read(error_class: int, data: bytes) -> None:
    report = read_error_frame(error_class, data)
    assert report.controller in (None, OK, PASSIVE, BUS_OFF)
