"""A box QP whose active bounds are known: its exact solution, and whether they are the right ones.

With the active bounds fixed, the solution and every margin that must not be
negative (distances to the bounds, multipliers) are linear in [g, lower, upper]:
one product of a matrix, made once for each set of active bounds.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Sides = tuple[int, ...]
"""For each variable -1 at the lower bound, 1 at the upper, 0 between them."""

MARGIN = -1e-12
"""Rounding may make a margin of zero this negative, for a Hessian of norm 1."""

MOST_REMEMBERED = 256
"""Sets of active bounds; a loop uses a few dozen."""


class ActiveSets:
    """Minimise x'Hx/2 + g'x over lower <= x_i <= upper for given active bounds; H (n, n).

    ``scale`` brings H to a norm of 1.
    """

    def __init__(self, hessian: FloatArray, scale: float) -> None:
        self._hessian, self._scale, self._n = hessian * scale, scale, len(hessian)
        self._known: dict[Sides, FloatArray] = {}
        self._sides: Sides = ()
        self._answers: FloatArray | None = None  # for the sides assumed
        self._margins: list[float] = []  # of the last question
        self._question = np.empty(self._n + 2)

    def assume(self, sides: Sides | None) -> None:
        """From now on these bounds are active; None: nobody knows."""
        self._sides = sides or ()
        self._answers = None if sides is None else self._answers_for(sides)

    def solve(self, gradient: FloatArray, lower: float, upper: float) -> FloatArray | None:
        """Solution x (n,), or None if other bounds than the assumed ones are active.

        Everything must be finite.
        """
        if self._answers is None:
            return None
        question, n = self._question, self._n
        question[:n] = gradient
        question[n], question[n + 1] = lower, upper
        answer: FloatArray = self._answers.dot(question)
        self._margins = answer[n:].tolist()
        return answer[:n] if min(self._margins) >= MARGIN else None

    def correct(self) -> None:
        """Assume better bounds after a question in vain: all that were wrong change sides."""
        sides, margins = list(self._sides), iter(self._margins)
        for index in (i for i, side in enumerate(self._sides) if side):
            if next(margins) < MARGIN:
                sides[index] = 0
        free = [i for i, side in enumerate(self._sides) if not side]
        for side in (-1, 1):
            for index in free:
                if next(margins) < MARGIN:
                    sides[index] = side
        self.assume(tuple(sides))

    def _answers_for(self, sides: Sides) -> FloatArray:
        answers = self._known.get(sides)
        if answers is None:
            if len(self._known) == MOST_REMEMBERED:
                self._known.clear()
            answers = self._known[sides] = _answers(self._hessian, np.array(sides))
            answers[:, : self._n] *= self._scale
        return answers


def _answers(hessian: FloatArray, sides: NDArray[np.int_]) -> FloatArray:
    """Matrix (n + n_fixed + 2 n_free, n + 2) from [g, lower, upper] to x and the margins."""
    n = len(sides)
    free, fixed = sides == 0, sides != 0
    gradient, (lower, upper) = np.eye(n, n + 2), np.eye(n + 2)[n:]
    x = np.where((sides > 0)[:, np.newaxis], upper, lower)
    x[free] = 0.0
    x[free] = -np.linalg.solve(hessian[np.ix_(free, free)], (gradient + hessian @ x)[free])
    multipliers = -sides[:, np.newaxis] * (gradient + hessian @ x)
    return np.vstack((x, multipliers[fixed], x[free] - lower, upper - x[free]))
