"""The torques under way."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tcs_hil.control.sent import MAX_DELAY_PERIODS, SentTorques


@pytest.fixture
def sent() -> SentTorques:
    torques = SentTorques()
    for torque_nm in (10.0, 20.0, 30.0):
        torques.push(torque_nm)
    return torques


def test_without_delay_nothing_is_pending(sent: SentTorques) -> None:
    assert sent.pending(0.0) == ([], 1.0)


def test_whole_periods_bring_the_newest_commands_oldest_first(sent: SentTorques) -> None:
    assert sent.pending(2.0) == ([20.0, 30.0], 1.0)


def test_of_a_fractional_delay_the_fraction_of_the_oldest_comes_first(sent: SentTorques) -> None:
    assert sent.pending(1.25) == ([20.0, 30.0], 0.25)


def test_before_the_first_command_no_torque_was_sent(sent: SentTorques) -> None:
    assert sent.pending(4.0) == ([0.0, 10.0, 20.0, 30.0], 1.0)
    sent.reset()
    assert sent.newest_nm == 0.0


@given(st.floats(-5.0, 50.0))
def test_the_periods_add_up_to_the_delay_within_its_bounds(delay_periods: float) -> None:
    torques_nm, first_periods = SentTorques().pending(delay_periods)
    expected = min(max(delay_periods, 0.0), MAX_DELAY_PERIODS)
    assert len(torques_nm) - 1.0 + first_periods == pytest.approx(expected)
    assert 0.0 < first_periods <= 1.0
