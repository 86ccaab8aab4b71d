"""`tcs-hil hil`: what it prints, leaves and exits with."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from tcs_hil.cli.hil import command
from tcs_hil.errors import TcsError

SCENARIO = """
description = "a launch, cut short"
duration_s = 0.3
start_speed_kmph = 5.0
controller = { kind = "pi" }
road = [{ mu = 0.3 }]
driver = { request = [[0.05, 0.0], [0.25, 250.0]] }
"""
LOOSE = '[[expect]]\nmetric = "peak slip"\nop = "<"\nvalue = 0.9\n'
STRICT = '[[expect]]\nsignal = "truth.request_nm"\nop = "<"\nvalue = 100\n'
TIMED = '[[expect]]\nmetric = "overruns"\nop = "=="\nvalue = 0\n'


@pytest.fixture
def hil(tmp_path: Path):
    def invoke(expectations: str, *arguments: str) -> Result:
        (tmp_path / "mine.toml").write_text(SCENARIO + expectations)
        fixed = [str(tmp_path / "mine.toml"), "--mode", "in-process", "-j", "1"]
        return CliRunner().invoke(
            command, [*fixed, "--out", str(tmp_path / "out"), *arguments], catch_exceptions=True
        )

    return invoke


@pytest.mark.parametrize(
    ("expectations", "status"), [(LOOSE, 0), (LOOSE + STRICT + TIMED, 1), (LOOSE + TIMED, 3)]
)
def test_the_exit_status_is_the_verdict(hil, expectations: str, status: int) -> None:
    assert hil(expectations).exit_code == status


def test_the_screen_says_what_failed_where_and_for_how_long(hil) -> None:
    output = hil(LOOSE + STRICT).output
    assert "failed" in output
    assert "truth.request_nm < 100 Nm: 250 Nm at 0.250 s (first at" in output
    assert "1 case: 0 passed, 1 failed, 0 blocked" in output


def test_with_json_a_program_reads_the_same(hil) -> None:
    result = hil(LOOSE, "--json", "--controller", "pi,off")
    suite = json.loads(result.stdout)
    assert [case["name"] for case in suite["results"]] == ["mine/pi", "mine/off"]
    assert suite["results"][0]["findings"][0]["limit"] == "peak slip < 0.9"


def test_an_earlier_run_is_compared_with(hil, tmp_path: Path) -> None:
    assert hil(LOOSE).exit_code == 0
    earlier = tmp_path / "earlier"
    (tmp_path / "out").rename(earlier)
    assert "failed (was passed)" in hil(STRICT, "--baseline", str(earlier)).output


def test_junit_is_written_where_it_is_wanted(hil, tmp_path: Path) -> None:
    hil(LOOSE, "--junit", str(tmp_path / "junit.xml"))
    assert 'classname="own.mine.pi"' in (tmp_path / "junit.xml").read_text()


@pytest.mark.parametrize(
    ("arguments", "complaint"),
    [
        (["--suite", "lunch"], "no suite 'lunch'"),
        (["--controller", "kpmc"], "--controller kpmc: the laws are off, pi, kmpc, nmpc"),
        (["--baseline", "nowhere"], "nowhere/results.json"),
        (["--junit", "nowhere/j.xml"], "nowhere/j.xml: there is no such folder"),
        (["no-such-scenario"], "'no-such-scenario' is neither"),
        (["--channel", "can0", "-j", "2", "--mode", "lockstep"], "one after another"),
        (["--channel", "can77", "--mode", "lockstep"], "there is no CAN interface can77"),
        (["--interface", "telepathy", "--mode", "lockstep"], "cannot open telepathy vcan0"),
        (["--channel", "can0"], "--channel: has no effect here; a run in process has no bus"),
        (["--bitrate", "500000", "--mode", "lockstep"], "--bitrate: has no effect here; without"),
    ],
)
def test_a_mistake_is_refused_by_name_before_anything_runs(
    hil, tmp_path: Path, arguments: list[str], complaint: str
) -> None:
    refusal = hil(LOOSE, *arguments).exception
    assert isinstance(refusal, TcsError)
    assert complaint in str(refusal)
    assert not (tmp_path / "out" / "runs").exists()
