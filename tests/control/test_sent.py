"""The torques under way, and the state rolled forward through them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tcs_hil.control.sent import MAX_DELAY_PERIODS, Piece, SentTorques, roll_forward


@pytest.fixture
def sent() -> SentTorques:
    torques = SentTorques()
    for torque_nm in (10.0, 20.0, 30.0):
        torques.push(torque_nm)
    return torques


class Accumulator:
    """State [torque impulse], in Nm periods."""

    def advance(self, state: np.ndarray, torque_nm: float, periods: float) -> np.ndarray:
        return state + torque_nm * periods


def test_without_delay_nothing_is_pending(sent: SentTorques) -> None:
    assert list(sent.pending(0.0)) == []


def test_whole_periods_bring_the_newest_commands_oldest_first(sent: SentTorques) -> None:
    assert list(sent.pending(2.0)) == [Piece(20.0, 1.0), Piece(30.0, 1.0)]


def test_of_a_fractional_delay_the_fraction_of_the_oldest_comes_first(sent: SentTorques) -> None:
    pieces = list(sent.pending(1.25))
    assert pieces == [Piece(20.0, pytest.approx(0.25)), Piece(30.0, 1.0)]


def test_before_the_first_command_no_torque_was_sent(sent: SentTorques) -> None:
    assert next(iter(sent.pending(4.0))) == Piece(0.0, 1.0)
    sent.reset()
    assert sent.newest_nm == 0.0


@given(st.floats(-5.0, 50.0))
def test_the_pieces_add_up_to_the_delay_within_its_bounds(delay_periods: float) -> None:
    pieces = list(SentTorques().pending(delay_periods))
    expected = min(max(delay_periods, 0.0), MAX_DELAY_PERIODS)
    assert sum(piece.periods for piece in pieces) == pytest.approx(expected)
    assert all(0.0 < piece.periods <= 1.0 for piece in pieces)


def test_the_state_is_carried_through_every_piece(sent: SentTorques) -> None:
    state = roll_forward(Accumulator(), np.zeros(1), sent, 2.5)
    assert state[0] == pytest.approx(0.5 * 10.0 + 20.0 + 30.0)
