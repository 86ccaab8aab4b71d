"""From a flight recording to what is shown, while it is written."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner
from runtime.fakes import RUN, numbered

from tcs_hil.cli.monitor import command
from tcs_hil.errors import ConfigError
from tcs_hil.hil.monitor.flight_view import FlightView
from tcs_hil.runtime.recorder import FlightRecorder
from tcs_hil.runtime.recording import RecordingError


def test_a_recording_without_a_tick_shows_nothing(tmp_path: Path) -> None:
    with FlightRecorder(tmp_path / "flight", RUN, 8):
        assert FlightView(tmp_path / "flight").snapshot(0) is None


def test_the_newest_tick_is_shown_while_the_service_runs(tmp_path: Path) -> None:
    with FlightRecorder(tmp_path / "flight", RUN, 8) as recorder:
        recorder.write(numbered(0))
        view = FlightView(tmp_path / "flight")
        recorder.write(numbered(1))
        snapshot = view.snapshot(0)
    assert snapshot is not None
    assert (snapshot.state, snapshot.controller) == ("ACTIVE", "NMPC")
    assert (snapshot.left.limit_nm, snapshot.right.limit_nm) == (61.0, None)
    assert (snapshot.left.slip_ratio, snapshot.right.slip_ratio) == (0.1, 0.2)
    assert snapshot.vehicle_speed_mps == 7.0
    assert {"wake_jitter", "total"} <= set(snapshot.times)
    assert view.history.points[-1].slip == (0.1, 0.2)


def test_one_look_is_printed_as_json(tmp_path: Path) -> None:
    path = tmp_path / "flight"
    with FlightRecorder(path, RUN, 8) as recorder:
        recorder.write(numbered(0))
    result = CliRunner().invoke(command, ["--flight", str(path), "--json"])
    assert json.loads(result.stdout)["left"]["request_nm"] == 51.0


def test_one_look_is_printed_for_people(tmp_path: Path) -> None:
    path = tmp_path / "flight"
    with FlightRecorder(path, RUN, 8) as recorder:
        recorder.write(numbered(0))
    result = CliRunner().invoke(command, ["--flight", str(path), "--once"])
    assert "ACTIVE" in result.stdout
    assert "jitter" in result.stdout


def test_a_recording_that_is_not_there_is_named(tmp_path: Path) -> None:
    result = CliRunner().invoke(command, ["--flight", str(tmp_path / "none")])
    assert isinstance(result.exception, RecordingError)
    assert "none" in str(result.exception)


@pytest.mark.parametrize("option", [["--control"], ["--channel", "vcan7"]])
def test_a_recording_has_no_bus_to_choose(tmp_path: Path, option: list[str]) -> None:
    result = CliRunner().invoke(command, ["--flight", str(tmp_path / "flight"), *option])
    assert isinstance(result.exception, ConfigError)


def test_a_recording_without_a_tick_is_a_sentence(tmp_path: Path) -> None:
    with FlightRecorder(tmp_path / "flight", RUN, 8):
        result = CliRunner().invoke(command, ["--flight", str(tmp_path / "flight"), "--once"])
    assert "no tick was made yet" in str(result.exception)
