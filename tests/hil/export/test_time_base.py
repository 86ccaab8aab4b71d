"""Log, telemetry and truth on one time base."""

from pathlib import Path

import numpy as np
import pytest
from hil.logs.made_run import (
    JITTER_NS,
    PERIOD_NS,
    PHASE_NS,
    PLANT_NS,
    STARTED_REALTIME_NS,
    TICKS,
)

from tcs_hil.errors import ConfigError
from tcs_hil.hil.export.gather import gather
from tcs_hil.hil.export.table import Instants, Run
from tcs_hil.hil.logs.sources import find_sources

GRID_NS = np.arange(TICKS) * PERIOD_NS
CLOCK_NS = 500  # calendar stamps are floating-point seconds: a quarter of a microsecond


def times(run: Run, name: str) -> Instants:
    return next(table.time_ns for table in run.tables if table.name == name)


@pytest.mark.parametrize("name", ["TorqueLimit", "WheelSpeedsRear", "BenchTick", "telemetry"])
def test_in_lockstep_every_source_has_the_bench_s_time(run: Run, name: str) -> None:
    np.testing.assert_array_equal(times(run, name), GRID_NS)
    np.testing.assert_array_equal(times(run, "truth"), GRID_NS)


def test_in_lockstep_the_start_is_the_first_frame_s(run: Run) -> None:
    expected_ns = STARTED_REALTIME_NS + PLANT_NS + JITTER_NS
    assert run.start_ns == pytest.approx(expected_ns, abs=CLOCK_NS)


def test_in_real_time_the_truth_begins_when_the_plant_should_have_woken(loose_run: Run) -> None:
    assert loose_run.start_ns == pytest.approx(STARTED_REALTIME_NS + PLANT_NS, abs=CLOCK_NS)
    np.testing.assert_array_equal(times(loose_run, "truth"), GRID_NS)


def test_in_real_time_frames_and_ticks_keep_their_clocks_instants(loose_run: Run) -> None:
    frames_ns, ticks_ns = times(loose_run, "WheelSpeedsRear"), times(loose_run, "telemetry")
    np.testing.assert_allclose(frames_ns, GRID_NS + JITTER_NS, atol=CLOCK_NS)
    np.testing.assert_allclose(ticks_ns, GRID_NS + PHASE_NS + 10_000, atol=CLOCK_NS)


def test_telemetry_alone_begins_with_its_first_tick(real_time: Path) -> None:
    run = gather(find_sources([real_time / "flight.tcsrec"]))
    np.testing.assert_array_equal(times(run, "telemetry"), GRID_NS)
    assert run.start_ns == STARTED_REALTIME_NS + PLANT_NS + PHASE_NS + 10_000


def test_truth_alone_begins_at_its_own_zero(real_time: Path) -> None:
    run = gather(find_sources([real_time / "truth.npz"]))
    np.testing.assert_array_equal(times(run, "truth"), GRID_NS)


def test_truth_beside_telemetry_needs_the_log_to_say_when_it_began(real_time: Path) -> None:
    files = [real_time / "truth.npz", real_time / "flight.tcsrec"]
    with pytest.raises(ConfigError, match="needs the bus log of its run"):
        gather(find_sources(files))
