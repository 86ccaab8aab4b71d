"""The percentile table, read back as a plotter would."""

from __future__ import annotations

import numpy as np
import pytest

from tcs_hil.runtime.histogram import hgrm


def rows(table: str) -> list[list[float]]:
    lines = table.splitlines()[2:]
    return [[float(cell) for cell in line.split()] for line in lines if not line.startswith("#")]


def test_the_first_line_is_the_smallest_value_and_the_last_the_largest() -> None:
    table = rows(hgrm(np.array([3.0, 1.0, 2.0])))
    assert table[0][:2] == [1.0, 0.0]
    assert table[-1] == [3.0, 1.0, 3]


def test_every_value_is_the_one_numpy_finds_at_that_share() -> None:
    samples = np.random.default_rng(2).permutation(np.arange(997.0))  # a prime: no share is a tie
    for value, share, below, *_ in rows(hgrm(samples)):
        assert value == np.quantile(samples, share, method="inverted_cdf")
        assert below == np.count_nonzero(samples <= value)


def test_lines_get_denser_towards_the_maximum() -> None:
    shares = [row[1] for row in rows(hgrm(np.arange(10_000.0)))]
    for expected in (0.5, 0.75, 0.9375, 0.999023437500):
        assert expected in shares
    assert sum(0.99 <= share < 1.0 for share in shares) > 30


def test_the_inverse_column_says_one_in_how_many() -> None:
    inverse = {row[1]: row[3] for row in rows(hgrm(np.arange(100.0))) if row[1] < 1.0}
    assert inverse[0.5] == 2.0
    assert inverse[0.9] == pytest.approx(10.0)


def test_the_footer_has_mean_deviation_maximum_and_count() -> None:
    footer = hgrm(np.array([1.0, 3.0]))
    assert "#[Mean    =        2.000, StdDeviation   =        1.000]" in footer
    assert "#[Max     =        3.000, Total count    =            2]" in footer


def test_a_single_sample_has_a_table() -> None:
    assert rows(hgrm(np.array([7.0])))[-1] == [7.0, 1.0, 1]
