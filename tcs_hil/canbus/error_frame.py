"""SocketCAN's error frames: what a CAN controller says about itself.

The kernel reports as a frame what no frame on the wire tells: the identifier's
flags name the class of the event, ``data[1]`` the controller's state.  A wrong
bit rate shows here and nowhere else: nothing can be received, and the
controller becomes error-passive.  Source: include/uapi/linux/can/error.h.
"""

from __future__ import annotations

from typing import NamedTuple

from tcs_hil.signals import BusCondition

CONTROLLER, BUS_OFF, RESTARTED = 0x004, 0x040, 0x100
"""Classes of events that say something about the controller's state."""

RX_OVERFLOW, TX_OVERFLOW = 0x01, 0x02
RX_WARNING, TX_WARNING = 0x04, 0x08
RX_PASSIVE, TX_PASSIVE = 0x10, 0x20
ACTIVE = 0x40
"""Bits of ``data[1]``; each state once for what was received and once for what was sent."""

_PASSIVE = RX_PASSIVE | TX_PASSIVE
_BETTER_THAN_PASSIVE = RX_WARNING | TX_WARNING | ACTIVE


class ErrorReport(NamedTuple):
    """What one error frame says.

    ``controller`` is the state from now on: OK (error-active, with or without
    a warning), ERROR_PASSIVE or BUS_OFF; None where the frame does not say.
    ``passing`` is what happened and is over.
    """

    controller: BusCondition | None
    passing: BusCondition


def read_error_frame(error_class: int, data: bytes) -> ErrorReport:
    """Read a frame marked as an error frame; its flags have been taken off the identifier."""
    details = data[1] if error_class & CONTROLLER and len(data) > 1 else 0
    return ErrorReport(_controller(error_class, details), _passing(details))


def _controller(error_class: int, details: int) -> BusCondition | None:
    if error_class & BUS_OFF:
        return BusCondition.BUS_OFF
    if details & _PASSIVE:
        return BusCondition.ERROR_PASSIVE
    if error_class & RESTARTED or details & _BETTER_THAN_PASSIVE:
        return BusCondition.OK
    return None


def _passing(details: int) -> BusCondition:
    if details & TX_OVERFLOW:
        return BusCondition.SEND_FAILED
    return BusCondition.OVERFLOW if details & RX_OVERFLOW else BusCondition.OK
