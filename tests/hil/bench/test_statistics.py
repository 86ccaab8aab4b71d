"""Times in a few figures."""

from __future__ import annotations

import gc

import numpy as np
import pytest

from tcs_hil.hil.bench.statistics import Statistics, Stopwatch, quiet_collector


def test_every_percentile_is_a_value_that_occurred() -> None:
    statistics = Statistics.of(np.arange(1.0, 1001.0)[::-1])
    assert statistics == Statistics(1000, 500.5, 500.0, 990.0, 999.0, 1000.0)


def test_reading_the_clocks_costs_nothing() -> None:
    watch = Stopwatch()
    for _ in range(100):
        watch.start()
        watch.stop()
    assert watch.cost.wall.p50_us < 0.1  # a reading takes about that, and is taken off
    assert watch.cost.cpu.samples == 100


def test_the_collector_rests_and_comes_back_even_after_an_error() -> None:
    def fail_quietly() -> None:
        with quiet_collector():
            raise ValueError(gc.isenabled())

    with pytest.raises(ValueError, match="False"):
        fail_quietly()
    assert gc.isenabled()
