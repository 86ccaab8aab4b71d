"""What wakes say about a machine, and the whole examination of this one."""

from __future__ import annotations

import json

import numpy as np
import pytest
from click.testing import CliRunner
from runtime.doctor.machines import FakeMachine
from runtime.fakes import FakeClock

from tcs_hil.cli import doctor
from tcs_hil.runtime.doctor.baseline import PERIOD_NS, baseline, cyclictest, wake_jitter_us
from tcs_hil.runtime.doctor.finding import Finding, Verdict
from tcs_hil.runtime.realtime import Grant

OK, WARN, FAIL = Verdict.OK, Verdict.WARN, Verdict.FAIL
GRANTED = (Grant("SCHED_FIFO 50", True, ""),)
CYCLICTEST = "T: 0 (  123) P:50 I:2000 C:   1000 Min:      3 Act:    9 Avg:    8 Max:      42\n"


class LateClock(FakeClock):
    """Wakes every sleeper 30 µs late, every fourth one 3 ms late."""

    sleeps = 0

    def sleep_until(self, deadline_ns: int) -> None:
        self.sleeps += 1
        self.time_ns = deadline_ns + (30_000 if self.sleeps % 4 else 3_000_000)


def test_jitter_is_wake_minus_the_point_of_the_grid() -> None:
    assert wake_jitter_us(LateClock(), 4).tolist() == [30.0, 30.0, 30.0, 3000.0]


def test_wakes_after_a_stall_are_measured_against_a_point_still_to_come() -> None:
    clock = LateClock()
    jitter_us = wake_jitter_us(clock, 8)
    assert jitter_us.tolist() == [30.0, 30.0, 30.0, 3000.0] * 2
    assert clock.time_ns == 9 * PERIOD_NS + 3_000_000  # the stall cost a point of the grid


@pytest.mark.parametrize(
    ("late_us", "verdict"), [(20.0, OK), (200.0, OK), (201.0, WARN), (2001.0, FAIL)]
)
def test_a_tenth_of_the_period_is_good_and_all_of_it_hopeless(
    late_us: float, verdict: Verdict
) -> None:
    assert baseline(np.full(1000, late_us), GRANTED).verdict is verdict


def test_what_was_not_granted_stands_beside_the_figures() -> None:
    refused = Grant("memory locked", False, "not permitted")
    assert baseline(np.ones(10), GRANTED).found == ("10 wakes: p50 1, p99 1, p99.9 1, max 1 µs")
    assert baseline(np.ones(10), (*GRANTED, refused)).found.endswith(", without memory locked")


def test_cyclictest_is_quoted_where_it_runs() -> None:
    assert cyclictest(FakeMachine(programs={"cyclictest": CYCLICTEST}), 1).found == (
        "min 3, mean 8, max 42 µs"
    )
    assert "not installed" in cyclictest(FakeMachine(), 1).found


FINDINGS = [
    Finding("a", OK, "fine"),
    Finding("b", WARN, "so so", "mend b"),
    Finding("c", FAIL, "broken", "mend c"),
]


@pytest.mark.parametrize(("count", "status"), [(1, 0), (2, 0), (3, 1)])
def test_only_a_missing_hard_requirement_is_an_exit_status(
    monkeypatch: pytest.MonkeyPatch, count: int, status: int
) -> None:
    monkeypatch.setattr(doctor, "examine", lambda *_: FINDINGS[:count])
    result = CliRunner().invoke(doctor.command)
    assert result.exit_code == status
    assert all(finding.what in result.output for finding in FINDINGS[:count])


def test_json_holds_verdict_and_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor, "examine", lambda *_: FINDINGS)
    findings = json.loads(CliRunner().invoke(doctor.command, ["--json"]).output)
    assert findings[1] == {"what": "b", "verdict": "warn", "found": "so so", "remedy": "mend b"}
