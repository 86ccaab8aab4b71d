"""How old the speed of a toothed wheel is."""

from __future__ import annotations

import numpy as np
import pytest

from tcs_hil.estimator.edge_age import OLDEST_S, EdgeAge
from tests.estimator.wheel_sensor import PERIOD_S, toothed

ACCEL_MPS2 = 1.5


def speed(time_s: float) -> float:
    return 2.0 + ACCEL_MPS2 * time_s


def test_with_its_age_a_shown_speed_tells_the_speed_now() -> None:
    age, shown_errors, errors = EdgeAge(PERIOD_S), [], []
    for time_s, shown_mps in toothed(speed, 2.0):
        aged_s = age.update(shown_mps)
        shown_errors.append(shown_mps - speed(time_s))
        errors.append(shown_mps + ACCEL_MPS2 * aged_s - speed(time_s))
    settled = slice(100, None)
    assert np.mean(shown_errors[settled]) < -0.005
    assert abs(np.mean(errors[settled])) < -0.5 * np.mean(shown_errors[settled])


def test_a_speed_that_changes_in_every_tick_is_half_a_period_old() -> None:
    age = EdgeAge(PERIOD_S)
    assert [age.update(1.0 + tick) for tick in range(3)][-1] == pytest.approx(0.5 * PERIOD_S)


def test_a_speed_that_stands_is_no_older_than_the_oldest() -> None:
    age = EdgeAge(PERIOD_S)
    assert [age.update(5.0) for _ in range(1000)][-1] == OLDEST_S
