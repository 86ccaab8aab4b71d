"""What Prometheus is told, asked through its own registry."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from msgspec.structs import replace
from msgspec.structs import replace as replace_struct
from prometheus_client import CollectorRegistry, generate_latest
from runtime.fakes import COMMAND, PERIOD_NS, RUN, insight, made_pass

from tcs_hil.runtime.exporter import OWN_COUNTERS, TIMES, FlightCollector
from tcs_hil.runtime.follower import Follower
from tcs_hil.runtime.record import record
from tcs_hil.runtime.recorder import FlightRecorder
from tcs_hil.runtime.recording import RunInfo
from tcs_hil.runtime.tick import Pass
from tcs_hil.signals import TcsState

NOW_NS = 10 * PERIOD_NS
Scrape = Callable[..., float | None]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "flight"


@pytest.fixture
def registry(path: Path) -> CollectorRegistry:
    registry = CollectorRegistry()
    registry.register(FlightCollector(Follower(path), lambda: NOW_NS))
    return registry


@pytest.fixture
def scrape(registry: CollectorRegistry) -> Scrape:
    return lambda name, **labels: registry.get_sample_value(f"tcs_hil_{name}", labels)


@pytest.fixture
def recorder(path: Path) -> Iterator[FlightRecorder]:
    with FlightRecorder(path, RUN, 8) as recorder:
        yield recorder


def write(recorder: FlightRecorder, *passes: Pass) -> None:
    for made in passes:
        recorder.write(record(made, insight(wheel_stamp_ns=PERIOD_NS)))


def test_without_a_recording_only_up_is_there_and_zero(
    scrape: Scrape, registry: CollectorRegistry
) -> None:
    assert scrape("up") == 0
    assert scrape("ticks_total") is None
    assert generate_latest(registry)


def test_ticks_and_troubles_are_counted_on_from_scrape_to_scrape(
    scrape: Scrape, recorder: FlightRecorder
) -> None:
    late = made_pass(sent_us=3000)
    skipper = replace(late, tick=replace(late.tick, skipped=4), failed=True)
    write(recorder, late, made_pass())
    assert [scrape(f"{name}_total") for name in ("ticks", "overruns")] == [2, 1]
    write(recorder, skipper)
    assert scrape("ticks_total") == 3
    assert scrape("overruns_total") == 2
    assert scrape("skipped_ticks_total") == 4
    assert scrape("failed_ticks_total") == 1


def test_the_counters_of_the_service_are_passed_on(
    scrape: Scrape, recorder: FlightRecorder
) -> None:
    write(recorder, made_pass())
    counts = [scrape(f"{name}_total") for name in OWN_COUNTERS]
    assert counts == [101, 102, 6, 4, 5, 6, 7]


def test_a_histogram_has_every_tick_in_the_bin_of_its_time(
    scrape: Scrape, recorder: FlightRecorder
) -> None:
    write(recorder, made_pass(sent_us=90), made_pass(sent_us=160))  # 80 µs and 150 µs of work
    assert scrape("total_seconds_bucket", le="5e-05") == 0
    assert scrape("total_seconds_bucket", le="0.0001") == 1
    assert scrape("total_seconds_bucket", le="0.0002") == 2
    assert scrape("total_seconds_bucket", le="+Inf") == 2
    assert scrape("total_seconds_sum") == pytest.approx(230e-6)


def test_a_time_on_the_bound_of_a_bin_is_in_it(scrape: Scrape, recorder: FlightRecorder) -> None:
    write(recorder, made_pass())  # woke 10 µs late
    assert scrape("wake_jitter_seconds_bucket", le="1e-05") == 1


def test_speeds_that_did_not_come_anew_are_no_latency_even_across_scrapes(
    scrape: Scrape, recorder: FlightRecorder
) -> None:
    write(recorder, made_pass())
    scrape("up")
    write(recorder, made_pass(1), made_pass(2))
    assert scrape("latency_seconds_count") == 1


def test_every_time_of_a_tick_is_exported(
    recorder: FlightRecorder, registry: CollectorRegistry
) -> None:
    write(recorder, made_pass())
    text = generate_latest(registry).decode()
    assert all(f"tcs_hil_{name}_seconds_count 1.0" in text for name in TIMES if name != "solve")
    assert "tcs_hil_solve_seconds_count 2.0" in text  # one of each wheel


def test_the_present_state_is_one_and_all_others_zero(
    scrape: Scrape, recorder: FlightRecorder
) -> None:
    write(recorder, replace(made_pass(), command=replace(COMMAND, state=TcsState.DEGRADED)))
    present = {state.name: scrape("state", state=state.name) for state in TcsState}
    assert present == {state.name: float(state is TcsState.DEGRADED) for state in TcsState}


def test_each_wheel_has_its_own_sample(scrape: Scrape, recorder: FlightRecorder) -> None:
    write(recorder, made_pass())
    assert scrape("torque_limit_nm", wheel="fl") == 61.0
    assert scrape("torque_limit_nm", wheel="fr") == float("inf")
    assert scrape("slip_ratio", wheel="fr") == 0.2


def test_the_age_of_the_newest_tick_tells_a_service_that_hangs(
    scrape: Scrape, recorder: FlightRecorder
) -> None:
    write(recorder, made_pass())
    assert scrape("last_tick_age_seconds") == pytest.approx((NOW_NS - PERIOD_NS) * 1e-9 - 90e-6)


def test_ticks_that_left_the_ring_unseen_are_counted(
    scrape: Scrape, recorder: FlightRecorder
) -> None:
    write(recorder, made_pass())
    assert scrape("unseen_ticks_total") == 0
    write(recorder, *[made_pass(n) for n in range(1, 20)])
    assert (scrape("ticks_total"), scrape("unseen_ticks_total")) == (20, 12)


def test_a_restarted_service_counts_from_zero(
    scrape: Scrape, recorder: FlightRecorder, path: Path
) -> None:
    write(recorder, made_pass(), made_pass())
    assert scrape("ticks_total") == 2
    other: RunInfo = replace_struct(RUN, started_monotonic_ns=99)
    with FlightRecorder(path, other, 8) as successor:
        write(successor, made_pass())
        assert (scrape("ticks_total"), scrape("unseen_ticks_total")) == (1, 0)
