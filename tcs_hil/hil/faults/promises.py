"""What the service owes each kind of fault: docs/safety.md as numbers.

Times count from the first tick that could tell; a cycle is that of the message.
"""

from __future__ import annotations

from tcs_hil.fault_codes import FaultCode
from tcs_hil.hil.faults.cell import Promise
from tcs_hil.signals import TcsState

TOLD_S = 0.0
"""A sensor that says it fails is believed in the tick that hears it."""
DRIVER_TOLD_S = 0.010
"""The request is sent in every fifth tick."""
TRUST_S = 0.02
"""Ten good ticks."""
AGREED_S = 0.1 + TRUST_S
"""A sensor is believed again once it has agreed for 100 ms; then ten good ticks."""
WINDOW_CYCLES = 14
"""What the E2E window takes at most to find a message VALID again."""

SMALL = "the error is smaller than what a healthy car shows"
STILL_TRUE = "the value is true until the speed has changed by 0.4 m/s and 5 %"
TOO_SHORT = "the error is gone again before 50 ms are over"
PEDAL = "a foot may do that"
UNCONTRADICTED = "nothing on the bus contradicts the value"
GRADE = "it may be a grade, and a car needs no accelerometer"
BEHIND = "it happens between the service's frames and the motor, where the service is blind"
BRIDGED = "two cycles are bridged"
ECHO = "the copy brings nothing new"
UNREAD = "no decision rests on it"


def nothing(why: str, *codes: FaultCode, back_s: float = AGREED_S) -> Promise:
    """Nothing is owed for the reason ``why``; ``codes`` may be named all the same."""
    return Promise(codes=frozenset(codes), back_s=back_s if codes else 0.0, why=why)


def told(*codes: FaultCode, state: TcsState = TcsState.DEGRADED) -> Promise:
    """The sensor says so itself."""
    return Promise(frozenset(codes), state, TOLD_S, TOLD_S, TRUST_S)


def found(
    within_s: float,
    *codes: FaultCode,
    state: TcsState = TcsState.DEGRADED,
    back_s: float = AGREED_S,
) -> Promise:
    """Physics or the other sensors contradict it."""
    return Promise(frozenset(codes), state, within_s, within_s, back_s)


def late(cycle_s: float, *codes: FaultCode) -> Promise:
    """Missing for three to ten cycles: limits do not rise, and no more."""
    return Promise(frozenset(codes), TcsState.DEGRADED, 3 * cycle_s, 3 * cycle_s, cycle_s + TRUST_S)


def lost(cycle_s: float, *codes: FaultCode, state: TcsState = TcsState.FAULT) -> Promise:
    """Missing or broken for more than ten cycles."""
    worst_s = 11 * cycle_s if state is TcsState.FAULT else 3 * cycle_s
    back_s = WINDOW_CYCLES * cycle_s + 2 * TRUST_S
    return Promise(frozenset(codes), state, 3 * cycle_s, worst_s, back_s)
