"""`[[expect]]` tables: refused by name, or judged."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hil.driven import launch

from plant_emulator.expect import Expect
from tcs_hil.errors import ConfigError
from tcs_hil.hil.judging.channels import namespace
from tcs_hil.hil.judging.checks import prepare
from tcs_hil.hil.judging.evidence import Series
from tcs_hil.hil.judging.limits import worst_sample
from tcs_hil.hil.judging.verdict import Finding, Verdict, judge, overall

PASSED, FAILED, BLOCKED = Verdict


def expect(op: str = "<", value: float | str = 1.0, **keys: Any) -> Expect:
    return Expect(op=op, value=value, **keys)  # type: ignore[arg-type]


def judged(op: str = "<", value: float | str = 1.0, **keys: Any) -> Finding:
    return judge([prepare(expect(op, value, **keys), None)], launch())[0]


@pytest.mark.parametrize(
    ("keys", "complaint"),
    [
        ({"signal": "truth.slip"}, "no signal 'truth.slip'; did you mean"),
        ({"metric": "slip rsme"}, "no metric 'slip rsme'; did you mean slip RMSE"),
        ({"metric": "peak"}, "of a signal: name the `signal`, too"),
        ({"metric": "peak slip", "signal": "speed_mps"}, "of the whole run: leave out `signal`"),
        ({"metric": "peek", "signal": "speed_mps"}, "did you mean peak"),
        ({"metric": "settling time", "signal": "speed_mps", "target": 1.0}, "needs a `band`"),
        ({"metric": "mean", "signal": "speed_mps", "target": 1.0}, "`target` means nothing"),
        ({"metric": "peak slip", "band": 1.0}, "`band` means nothing"),
        ({"signal": "speed_mps", "target": 1.0}, "`target` means nothing"),
        ({"metric": "speed gained ratio", "from_s": 1.0}, "takes no window"),
        ({"signal": "service.state", "value": "ACTVE"}, "is one of OFF, INIT, .*not 'ACTVE'"),
        ({"metric": "peak slip", "value": "much"}, "is a number, not 'much'"),
    ],
)
def test_what_cannot_be_meant_is_refused_before_anything_runs(
    keys: dict[str, Any], complaint: str
) -> None:
    with pytest.raises(ConfigError, match=complaint):
        prepare(expect(**keys), None)


def test_a_limit_that_is_kept_says_how_near_it_came() -> None:
    finding = judged(signal="truth.request_nm", op="<=", value=250.0)
    assert (finding.verdict, finding.measured, finding.unit) == (PASSED, 250.0, "Nm")
    assert finding.at_s == pytest.approx(0.25)


def test_a_limit_that_is_broken_says_where_it_was_worst_and_for_how_long() -> None:
    finding = judged(signal="truth.request_nm", op="<", value=200.0)
    assert (finding.verdict, finding.measured) == (FAILED, 250.0)
    assert finding.reason == "250 Nm at 0.250 s (first at 0.210 s, 288 ms in all)"


def test_only_the_window_is_judged() -> None:
    assert judged(signal="truth.request_nm", value=200.0, to_s=0.2).verdict is PASSED
    assert judged(signal="truth.request_nm", value=200.0, from_s=0.2).verdict is FAILED


def test_a_window_the_run_never_came_to_is_blocked() -> None:
    for keys in ({"signal": "truth.request_nm"}, {"metric": "peak slip"}):
        assert judged(**keys, from_s=10.0).verdict is BLOCKED


@pytest.mark.parametrize(
    "keys", [{"metric": "latency p99"}, {"metric": "overruns"}, {"signal": "service.latency_us"}]
)
def test_the_machines_times_cannot_be_judged_without_a_clock(keys: dict[str, Any]) -> None:
    finding = judged(value=1e9, **keys)
    assert finding.verdict is BLOCKED
    assert "--mode real-time" in finding.reason


def test_states_are_compared_by_name() -> None:
    assert judged("!=", "FAULT", signal="service.state").verdict is PASSED
    failed = judged("!=", "ACTIVE", signal="service.state")
    assert (failed.verdict, failed.reason.split(" at ")[0]) == (FAILED, "ACTIVE")


def test_bus_service_and_truth_tell_of_the_same_instant() -> None:
    for name in ("bus.DriverTorqueRequestL", "service.driver_torque_fl_nm", "truth.request_nm"):
        reached = judged(metric="time to reach", signal=name, target=100.0)
        assert reached.measured == pytest.approx(0.13, abs=0.011), name  # a frame every 10 ms


def test_a_column_of_the_truth_is_the_one_its_name_says() -> None:
    truth, end_s = launch().truth, launch().end_s
    final = judged(metric="final", signal="truth.motor_torque_fr_nm")
    assert (final.measured, final.at_s) == (truth["motor_torque_nm"][-1, 1], end_s)


@pytest.mark.parametrize(
    ("metric", "low", "high"),
    [
        ("peak slip", 0.05, 0.4),
        ("slip RMSE", 0.0, 0.3),
        ("speed gained", 0.1, 1.0),
        ("speed gained ratio", 0.2, 1.05),
        ("mean |dT/dt|", 10.0, 2000.0),
        ("longest spin", 0.0, 0.0),
        ("limit cycles", 0.0, 0.0),
        ("limit above request", -250.0, 0.0),
        ("lowest limit", 0.0, 250.0),
        ("failed ticks", 0.0, 0.0),
        ("solver failures", 0.0, 0.0),
        ("E2E errors", 0.0, 0.0),
        ("input age max", 0.0, 4000.0),
    ],
)
def test_metrics_of_a_run_are_in_a_sane_range(metric: str, low: float, high: float) -> None:
    measured = judged(metric=metric).measured
    assert measured is not None
    assert low <= measured <= high


def test_the_worst_sample_is_the_farthest_beyond_or_the_nearest_to_the_limit() -> None:
    series = Series(np.arange(4.0), np.array([1.0, 3.0, 2.0, 2.5]))
    assert worst_sample(series, "<", 2.2).at_s == 1.0
    assert worst_sample(series, ">", 2.2).at_s == 0.0
    assert worst_sample(series, "==", 2.4).at_s == 0.0
    assert worst_sample(series, "!=", 2.4).at_s == 3.0


def test_what_is_not_a_number_keeps_no_limit() -> None:
    series = Series(np.arange(3.0), np.array([1.0, np.nan, 1.0]))
    worst = worst_sample(series, "!=", 5.0)
    assert np.isnan(worst.value)
    assert worst.at_s == 1.0
    assert not prepare(expect("!=", 5.0, signal="truth.speed_mps"), None).kept(worst.value)


def test_in_real_time_the_plants_silence_after_its_end_is_not_judged() -> None:
    run = launch("real-time")
    judged_s = run.series(namespace(None).find("service.state")).time_s
    assert run.tick_time_s[-1] > run.end_s
    assert 0.0 <= judged_s[0] < judged_s[-1] <= run.end_s - 0.01


def test_blocked_is_never_passed() -> None:
    assert overall([PASSED, PASSED]) is PASSED
    assert overall([PASSED, BLOCKED]) is BLOCKED
    assert overall([PASSED, BLOCKED, FAILED]) is FAILED
    assert overall([]) is BLOCKED
