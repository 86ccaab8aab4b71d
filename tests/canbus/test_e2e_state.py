"""The E2E state machine, against a plain reading of the standard and by hand."""

from __future__ import annotations

from collections import deque

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tcs_hil.canbus.e2e import E2EStatus
from tcs_hil.canbus.e2e_state import StateMachine, Threshold, WindowSpec
from tcs_hil.signals import InputState

OK, REPEATED, WRONG, ERROR, ABSENT = E2EStatus
NO_DATA, INIT, VALID, INVALID = (InputState(number) for number in range(4))
SPEC = WindowSpec(
    size=6,
    init=Threshold(min_ok=3, max_error=1),
    valid=Threshold(min_ok=2, max_error=2),
    invalid=Threshold(min_ok=4, max_error=1),
)


def fed(machine, statuses):
    """State after each status."""
    states = []
    for status in statuses:
        if status is ABSENT:
            machine.add_missed(1)
        else:
            machine.add(status)
        states.append(machine.state)
    return states


def states(*statuses):
    return fed(StateMachine(SPEC), statuses)


def valid_machine():
    machine = StateMachine(SPEC)
    assert fed(machine, [OK] * 7)[-1] is VALID
    return machine


def test_there_is_no_data_before_the_first_frame():
    assert StateMachine(SPEC).state is NO_DATA


@pytest.mark.parametrize("status", [ERROR, ABSENT])
def test_neither_silence_nor_a_broken_frame_is_data(status):
    assert states(*[status] * 20) == [NO_DATA] * 20


@pytest.mark.parametrize("status", [OK, REPEATED, WRONG])
def test_any_frame_with_a_good_checksum_starts_the_count(status):
    assert states(status) == [INIT]


def test_the_first_frame_does_not_count_and_enough_good_ones_make_it_valid():
    assert states(OK, OK, OK, OK) == [INIT, INIT, INIT, VALID]


def test_an_error_in_init_only_delays():
    assert states(OK, OK, ERROR, OK, OK) == [INIT, INIT, INIT, INIT, VALID]


def test_too_many_errors_in_init_make_it_invalid():
    assert states(OK, ERROR, ERROR) == [INIT, INIT, INVALID]


def test_silence_in_init_is_waited_out():
    assert states(OK, *[ABSENT] * 20, OK, OK, OK)[-4:] == [INIT, INIT, INIT, VALID]


def test_as_many_errors_as_allowed_are_bridged_and_one_more_is_not():
    assert fed(valid_machine(), [ERROR, ERROR, OK]) == [VALID] * 3
    assert fed(valid_machine(), [ERROR, ERROR, ERROR]) == [VALID, VALID, INVALID]


@pytest.mark.parametrize("status", [REPEATED, WRONG, ABSENT])
def test_a_window_that_runs_out_of_good_frames_makes_it_invalid(status):
    assert fed(valid_machine(), [status] * 5) == [VALID] * 4 + [INVALID]


def test_errors_are_forgotten_once_they_have_left_the_window():
    assert set(fed(valid_machine(), [ERROR, ERROR, OK, OK, OK, OK] * 5)) == {VALID}


def test_back_to_valid_only_after_enough_good_frames():
    machine = valid_machine()
    assert fed(machine, [ABSENT] * 6)[-1] is INVALID
    assert fed(machine, [OK] * 4) == [INVALID, INVALID, INVALID, VALID]


def test_back_to_valid_only_once_the_errors_have_left_the_window():
    machine = valid_machine()
    assert fed(machine, [ERROR] * 6)[-1] is INVALID
    assert fed(machine, [OK] * 5) == [INVALID] * 4 + [VALID]


@pytest.mark.parametrize("cycles", [6, 7, 10**18])
def test_a_long_silence_is_counted_at_once_and_holds_nothing_back(cycles):
    machine = valid_machine()
    machine.add_missed(cycles)
    assert machine.state is INVALID
    assert fed(machine, [OK] * 4)[-1] is VALID


class Standard:
    """The machine written down as in the standard: a ring of statuses, counted anew each time."""

    def __init__(self):
        self.state = NO_DATA
        self.window = deque([ABSENT] * SPEC.size, maxlen=SPEC.size)

    def add(self, status):
        if self.state is NO_DATA:
            self.state = NO_DATA if status in (ERROR, ABSENT) else INIT
            return
        self.window.append(status)
        oks, errors = self.window.count(OK), self.window.count(ERROR)
        if self.state is INIT:
            good, bad = errors <= 1 and oks >= 3, errors > 1
        elif self.state is VALID:
            good = errors <= 2 and oks >= 2
            bad = not good
        else:
            good, bad = errors <= 1 and oks >= 4, False
        self.state = VALID if good else INVALID if bad else self.state


@given(st.lists(st.sampled_from(E2EStatus), max_size=60))
def test_it_agrees_with_the_standard_after_every_status(statuses):
    machine, standard = StateMachine(SPEC), Standard()
    for status in statuses:
        (state,) = fed(machine, [status])
        standard.add(status)
        assert state is standard.state
