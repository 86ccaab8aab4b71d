"""The summary against numpy and against counting by hand."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace
from runtime.fakes import COMMAND, PERIOD_NS, RUN, TRACE, insight, made_pass

from tcs_hil.canbus.frame import PortCounters
from tcs_hil.control.protocol import Proposal, SolveStatus
from tcs_hil.runtime.record import Record, record
from tcs_hil.runtime.recorder import FlightRecorder
from tcs_hil.runtime.recording import read
from tcs_hil.runtime.summary import Summary, summarise
from tcs_hil.signals import BusCondition, TcsState

Summarised = Callable[[list[Record]], Summary]


@pytest.fixture
def summarised(tmp_path: Path) -> Summarised:
    def through_the_recorder(records: list[Record]) -> Summary:
        with FlightRecorder(tmp_path / "flight.rec", RUN, len(records) + 2) as recorder:
            for values in records:
                recorder.write(values)
        return summarise(read(tmp_path / "flight.rec"))

    return through_the_recorder


def test_percentiles_are_those_of_numpy(summarised: Summarised) -> None:
    sent_us = np.random.default_rng(1).integers(
        60, 1_000_000, 4999
    )  # no share falls between two floats
    summary = summarised([record(made_pass(sent_us=int(us)), insight()) for us in sent_us])
    assert summary.total is not None
    total_us = sent_us - 10
    for found, share in (
        (summary.total.p50_us, 50),
        (summary.total.p99_us, 99),
        (summary.total.p99_9_us, 99.9),
        (summary.total.p99_99_us, 99.99),
        (summary.total.max_us, 100),
    ):
        expected = np.percentile(total_us, share, method="inverted_cdf")
        assert found == pytest.approx(expected, rel=1e-12)  # ns to µs is one rounding
    assert summary.total.mean_us == pytest.approx(total_us.mean())
    assert summary.total.samples == 4999


def test_each_stage_is_the_time_since_the_one_before(summarised: Summarised) -> None:
    summary = summarised([record(made_pass(), insight(wheel_stamp_ns=PERIOD_NS))])
    stages = (summary.wake_jitter, summary.receive, summary.step, summary.send, summary.total)
    assert [stage and round(stage.max_us, 6) for stage in stages] == [10, 10, 30, 40, 80]
    assert summary.latency is not None
    assert summary.latency.max_us == pytest.approx(90)


def test_what_was_never_measured_has_no_distribution(summarised: Summarised) -> None:
    lost = made_pass()
    lost = replace(lost, measurement=replace(lost.measurement, rear_speed_age_s=math.inf))
    summary = summarised([record(lost, insight())])
    assert summary.latency is None
    assert summary.input_age is None


def test_overruns_skips_and_failures_are_counted(summarised: Summarised) -> None:
    late = made_pass(sent_us=3000)
    skipper = replace(late, tick=replace(late.tick, skipped=4), failed=True)
    summary = summarised([record(made, insight()) for made in (late, skipper, made_pass())])
    assert (summary.ticks, summary.overruns, summary.skipped, summary.failures) == (3, 2, 4, 1)
    assert (summary.bus_errors, summary.lost_frames, summary.e2e_errors) == (6, 4, 5)


@pytest.mark.parametrize(
    ("condition", "heard", "told"),
    [
        (BusCondition.ERROR_PASSIVE, 0, True),
        (BusCondition.BUS_OFF, 0, True),
        (BusCondition.ERROR_PASSIVE, 1, False),
        (BusCondition.SEND_FAILED, 0, False),
        (BusCondition.OK, 0, False),
    ],
)
def test_errors_without_a_single_good_frame_look_like_another_bit_rate(
    summarised: Summarised, condition: BusCondition, heard: int, told: bool
) -> None:
    made = made_pass()
    ill = replace(made, measurement=replace(made.measurement, bus=condition))
    met = replace(insight(), counters=PortCounters(rx=heard))
    advice = summarised([record(ill, met), record(made_pass(), met)]).advice
    assert advice.startswith("bit rate mismatch?") is told


def test_states_and_statuses_are_counted_by_name(summarised: Summarised) -> None:
    failed = replace(
        TRACE, proposals=(Proposal(51.0, SolveStatus.FAILED), Proposal(52.0, SolveStatus.OK))
    )
    degraded = replace(made_pass(), command=replace(COMMAND, state=TcsState.DEGRADED))
    summary = summarised(
        [
            record(made_pass(), insight()),
            record(degraded, replace(insight(), trace=failed)),
        ]
    )
    assert summary.states == {"ACTIVE": 1, "DEGRADED": 1}
    assert summary.statuses == {"OK": 3, "FAILED": 1}


def test_a_law_that_was_not_asked_is_in_no_count(summarised: Summarised) -> None:
    unasked = replace(TRACE, proposals=(Proposal(math.nan), Proposal(math.nan)))
    summary = summarised([record(made_pass(), replace(insight(), trace=unasked))])
    assert summary.statuses == {}
    assert summary.solve is None


def test_a_summary_is_json(summarised: Summarised) -> None:
    table = json.loads(json.dumps(summarised([record(made_pass(), insight())]).as_dict()))
    assert table["ticks"] == 1
    assert table["total"]["samples"] == 1


def test_an_empty_recording_has_an_empty_summary(summarised: Summarised) -> None:
    summary = summarised([])
    assert summary.ticks == 0
    assert not summary.advice
    assert summary.wake_jitter is None
