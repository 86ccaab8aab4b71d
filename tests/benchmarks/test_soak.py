"""The soak's eyes and its verdict; the soak itself takes half an hour."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import pytest
from runtime.fakes import PERIOD_NS, RUN, insight, made_pass

from benchmarks.soak import conclusion, scenario, table
from benchmarks.soak_samples import Footprint, Sample, Ticking, Watcher, judge
from plant_emulator.scenario import load_scenario
from tcs_hil.runtime.record import record
from tcs_hil.runtime.recorder import FlightRecorder

QUIET = Ticking(1000, 0, 0, 0, 500, 0, 10.0, 20.0, 1, 1, 0, 0, 0)
PLANT = Footprint(1000, 5, 1)
HOUR_S = 3600.0


def hour(rss_kib: tuple[int, ...], descriptors: tuple[int, ...] = ()) -> list[Sample]:
    """Samples over an hour, with the service's memory and descriptors as given."""
    counts = descriptors or (6,) * len(rss_kib)
    step_s = HOUR_S / (len(rss_kib) - 1)
    return [
        Sample(number * step_s, Footprint(rss, count, 2), PLANT, QUIET)
        for number, (rss, count) in enumerate(zip(rss_kib, counts, strict=True))
    ]


def test_memory_that_stays_is_flat() -> None:
    verdict = judge(hour((5000, 5100, 5100, 5100)), 0.0)
    assert verdict.flat
    assert verdict.growth_kib_per_h == pytest.approx(90.0)


def test_a_byte_forgotten_in_every_tick_is_not_flat() -> None:
    in_an_hour_kib = 500 * 3600 // 1024
    assert not judge(hour((5000, 5000 + in_an_hour_kib // 2, 5000 + in_an_hour_kib)), 0.0).flat


def test_the_warm_up_is_not_judged() -> None:
    assert judge(hour((100, 5000, 5000)), HOUR_S / 2).flat


def test_a_descriptor_left_open_is_not_flat() -> None:
    assert not judge(hour((5000, 5000, 5000), (6, 6, 7)), 0.0).flat


@pytest.mark.parametrize("wrong", [{"drift_ns": 1}, {"failures": 1}])
def test_a_grid_that_drifts_or_a_tick_that_fails_is_not_flat(wrong: dict[str, int]) -> None:
    samples = hour((5000, 5000, 5000))
    samples[1] = replace(samples[1], ticking=replace(QUIET, **wrong))
    assert not judge(samples, 0.0).flat


def test_a_process_is_looked_at_from_outside() -> None:
    before = Footprint.of(os.getpid())
    with Path("/dev/null").open():
        assert Footprint.of(os.getpid()).descriptors == before.descriptors + 1
    assert before.rss_kib > 1000
    assert before.threads >= 1


def test_ticks_are_read_once_and_the_grid_is_held_to_their_numbers(tmp_path: Path) -> None:
    watcher = Watcher(tmp_path / "flight")
    with FlightRecorder(tmp_path / "flight", RUN, 16) as recorder:
        for number in (0, 1, 4):
            made = made_pass(number, scheduled_ns=(number + 1) * PERIOD_NS)
            recorder.write(record(made, insight()))
        first = watcher.look()
        late = made_pass(5, scheduled_ns=6 * PERIOD_NS + 7)
        recorder.write(record(late, insight()))
        second = watcher.look()
        assert watcher.look() is None
    assert first is not None
    assert second is not None
    assert (first.ticks, first.drift_ns, first.lost_frames) == (3, 0, 4)
    assert (second.ticks, second.drift_ns) == (1, 7)


def test_the_hill_is_a_scenario_that_launches_every_half_minute(tmp_path: Path) -> None:
    path = tmp_path / "hill.toml"
    path.write_text(scenario(65.0))
    requests = load_scenario(str(path)).driver.request
    assert [time_s for time_s, _ in requests if time_s % 30.0 == 1.0] == [1.0, 31.0, 61.0]


def test_the_rate_is_that_of_the_ticks_between_the_looks() -> None:
    samples = hour((5000,) * 1801)  # 1000 ticks every two seconds
    text = conclusion(samples, judge(samples, 0.0), 0.0)[1]
    assert "1801000 ticks in 60.0 minutes, 500.0 a second" in text


def test_the_table_adds_up_what_lies_between_two_rows() -> None:
    lines = table(hour((5000,) * 24))
    assert len(lines) == 2 + 12
    assert "| 2000 |" in lines[2]
