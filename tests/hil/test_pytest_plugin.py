"""The plug-in, in a test session of somebody else's."""

from __future__ import annotations

import pytest

# A session inside this one forgets what it imports; compiled modules load only once.
import tcs_hil.hil.driven_run  # noqa: F401

pytest_plugins = ["pytester"]

ONCE = ("-p", "no:tcs_hil", "-p", "tcs_hil.hil.pytest_plugin")
"""Where the project is installed, pytest has found the plug-in already."""

SCENARIO = """
description = "a launch, cut short"
duration_s = 0.3
start_speed_kmph = 5.0
road = [{ mu = 0.3 }]
driver = { request = [[0.05, 0.0], [0.25, 250.0]] }

[[expect]]
metric = "peak slip"
op = "<"
value = 0.01
"""


@pytest.fixture
def session(pytester: pytest.Pytester):
    pytester.makefile(".toml", launch=SCENARIO)

    def run(body: str) -> pytest.RunResult:
        lines = "\n".join(f"    {line}" for line in body.splitlines())
        pytester.makepyfile(f"def test_launch(hil):\n{lines}\n")
        return pytester.runpytest_inprocess(*ONCE)

    return run


def test_a_test_drives_a_scenario_and_says_what_it_expects(session) -> None:
    result = session("""
run = hil("launch.toml", controller="pi")
run.expect("peak slip", "<", 0.9)
run.expect("service.state", "!=", "FAULT")
run.expect("time to reach", "<", 0.3, signal="service.state", target="STANDBY")
assert run.series("truth.speed_mps").values[0] > 1.0
""")
    result.assert_outcomes(passed=1)


def test_a_limit_that_was_not_kept_fails_with_the_place_and_the_files(session) -> None:
    result = session('hil("launch.toml", controller="pi").expect("truth.request_nm", "<", 100)')
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        ["*failed: truth.request_nm < 100 Nm: 250 Nm at 0.250 s*", "*the run is in /*launch/pi*"]
    )


def test_what_cannot_be_judged_does_not_pass(session) -> None:
    result = session('hil("launch.toml", controller="pi").expect("latency p99", "<", 1e9)')
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*blocked: latency p99 < *"])


def test_the_scenario_may_bring_its_own_limits(session) -> None:
    result = session('hil("launch.toml", controller="pi").keep_its_limits()')
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*failed: peak slip < 0.01: *"])


def test_a_misspelt_name_is_an_error_of_the_test(session) -> None:
    result = session('hil("launch.toml", controller="pi").expect("peak slpi", "<", 0.3)')
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        ["*ConfigError: there is no metric 'peak slpi'; did you mean peak slip*"]
    )
