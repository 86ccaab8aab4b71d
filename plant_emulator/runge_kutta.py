"""The vector arithmetic of the classic Runge-Kutta step, without temporaries."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from plant_emulator.compiled import compiled
from plant_emulator.truth import ROW_SIZE

MAX_STEP_S = 1e-4
"""Longest integration step; docs/plant.md shows why it is short enough."""


STAGES = (0.0, 0.5, 0.5, 1.0)
"""Where in the step each of the four stages looks."""


class Work(NamedTuple):
    """Arrays a step works in, made once so that nothing is allocated while driving."""

    rates: NDArray[np.float64]  # (4, states), derivative in each stage
    trial: NDArray[np.float64]  # (states,), what a stage looks at
    row: NDArray[np.float64]  # (ROW_SIZE,), what acts there


def work_for(states: int) -> Work:
    """Make the arrays for a system of ``states``."""
    return Work(np.zeros((4, states)), np.zeros(states), np.zeros(ROW_SIZE))


@compiled
def steps_for(duration_s: float) -> int:
    """How many equal steps of at most 0.1 ms make ``duration_s``."""
    return max(1, int(np.ceil(duration_s / MAX_STEP_S - 1e-6)))


@compiled
def blend(
    out: NDArray[np.float64],
    state: NDArray[np.float64],
    factor: float,
    rate: NDArray[np.float64],
) -> None:
    """Write state + factor x rate into ``out``: the state a stage looks at."""
    for i in range(state.size):
        out[i] = state[i] + factor * rate[i]


@compiled
def conclude(state: NDArray[np.float64], h: float, rates: NDArray[np.float64]) -> None:
    """Take the step of ``h`` with the rates of its four stages, (4, states)."""
    for i in range(state.size):
        state[i] += h / 6.0 * (rates[0, i] + 2.0 * (rates[1, i] + rates[2, i]) + rates[3, i])
