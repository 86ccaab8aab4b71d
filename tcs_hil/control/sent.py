"""The torques on their way to the wheel, and the state rolled forward through them."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

MAX_DELAY_PERIODS = 10.0
"""Beyond it (20 ms) prediction is no remedy any more."""


class Piece(NamedTuple):
    """A torque, and for how many periods (at most one) it acts."""

    torque_nm: float
    periods: float


class SentTorques:
    """What one wheel's law has proposed lately, newest last.

    A state that is ``d`` periods older than the first effect of the next
    command will still see ``d`` periods of earlier ones.
    """

    def __init__(self) -> None:
        self._sent: deque[float] = deque(maxlen=int(MAX_DELAY_PERIODS) + 1)
        self.reset()

    @property
    def newest_nm(self) -> float:
        """The command before the one to be decided; 0 at the start."""
        return self._sent[-1]

    def push(self, torque_nm: float) -> None:
        """Remember what this tick has proposed."""
        self._sent.append(torque_nm)

    def pending(self, delay_periods: float) -> Iterator[Piece]:
        """Torques that act within the delay, oldest first; their periods add up to it.

        Of a fractional delay the fraction comes first: the oldest command has
        acted for the rest of its period already.
        """
        delay_periods = min(max(delay_periods, 0.0), MAX_DELAY_PERIODS)
        whole = int(delay_periods)
        newest = len(self._sent)
        if delay_periods > whole:
            yield Piece(self._sent[newest - whole - 1], delay_periods - whole)
        for index in range(newest - whole, newest):
            yield Piece(self._sent[index], 1.0)

    def reset(self) -> None:
        """As at start-up: no torque was ever sent."""
        self._sent.extend([0.0] * int(MAX_DELAY_PERIODS + 1.0))


class Predicts(Protocol):
    """A prediction model that can be run for a period or a part of one."""

    def advance(self, state: FloatArray, torque_nm: float, periods: float) -> FloatArray:
        """State (nx,) after ``periods`` in (0, 1] periods of a commanded motor torque."""
        ...


def roll_forward(
    model: Predicts, state: FloatArray, sent: SentTorques, delay_periods: float
) -> FloatArray:
    """State (nx,) at which the command to be decided begins to act."""
    for torque_nm, periods in sent.pending(delay_periods):
        state = model.advance(state, torque_nm, periods)
    return state
