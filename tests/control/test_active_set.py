"""A box QP with known active bounds: exact where they are right, silent where they are not."""

from __future__ import annotations

import numpy as np
import pytest

from tcs_hil.control import active_set
from tcs_hil.control.active_set import ActiveSets

HESSIAN = np.array([[2.0, 0.5, 0.0], [0.5, 1.0, 0.2], [0.0, 0.2, 3.0]])
SCALE = 1.0 / float(np.linalg.eigvalsh(HESSIAN)[-1])
MINIMUM = np.array([0.3, -4.0, 0.9])  # the second element lies below the box


@pytest.fixture
def sets() -> ActiveSets:
    return ActiveSets(HESSIAN, SCALE)


def solve(sets: ActiveSets) -> np.ndarray | None:
    return sets.solve(-HESSIAN @ MINIMUM, -1.0, 1.0)


def test_with_the_right_bounds_the_solution_is_exact(sets: ActiveSets) -> None:
    sets.assume((0, -1, 0))
    x = solve(sets)
    assert x is not None
    slope = HESSIAN @ (x - MINIMUM)
    assert x[1] == -1.0
    np.testing.assert_allclose(slope[[0, 2]], 0.0, atol=1e-14)
    assert slope[1] > 0.0


@pytest.mark.parametrize("sides", [(0, 0, 0), (1, -1, 0), (0, 1, 0), (-1, -1, -1)])
def test_with_wrong_bounds_there_is_none(sets: ActiveSets, sides: tuple[int, ...]) -> None:
    sets.assume(sides)
    assert solve(sets) is None


def test_nothing_assumed_is_nothing_known(sets: ActiveSets) -> None:
    assert solve(sets) is None
    sets.assume((0, -1, 0))
    sets.assume(None)
    assert solve(sets) is None


@pytest.mark.parametrize("sides", [(0, 0, 0), (1, -1, 0), (-1, 1, 1)])
def test_corrections_lead_to_the_right_bounds(sets: ActiveSets, sides: tuple[int, ...]) -> None:
    sets.assume(sides)
    for _ in range(4):
        if solve(sets) is not None:
            break
        sets.correct()
    sets_x = solve(sets)
    assert sets_x is not None
    assert sets_x[1] == -1.0


def test_only_so_many_sets_of_bounds_are_remembered(
    sets: ActiveSets, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(active_set, "MOST_REMEMBERED", 2)
    for sides in [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, -1, 0)]:
        sets.assume(sides)
    assert solve(sets) is not None
