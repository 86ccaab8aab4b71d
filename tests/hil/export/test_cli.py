"""``tcs-hil export`` as it is called."""

import json
from pathlib import Path

import can
import pytest
from click.testing import CliRunner, Result
from hil.logs.made_run import TICKS

from tcs_hil.cli.damage import INCOMPLETE
from tcs_hil.cli.export import command
from tcs_hil.errors import ConfigError


def run(*arguments: object) -> Result:
    runner = CliRunner(catch_exceptions=False)
    return runner.invoke(command, list(map(str, arguments)), standalone_mode=False)


def test_a_run_s_folder_becomes_a_file(lockstep: Path, tmp_path: Path) -> None:
    output = run(lockstep, "-o", tmp_path / "run.csv").stdout
    assert (tmp_path / "run.csv").exists()
    assert f"{tmp_path / 'run.csv'}: " in output
    assert "11 sources" in output
    assert "starts 2026-09-21T14:13:20" in output


def test_parts_of_a_run_can_be_left_out(lockstep: Path, tmp_path: Path) -> None:
    output = run(lockstep / "truth.npz", "-o", tmp_path / "run.csv").stdout
    assert f"{TICKS} samples, 1 source, 0 frames" in output


def test_a_candump_log_is_said_to_hold_frames_alone(lockstep: Path, tmp_path: Path) -> None:
    output = run(lockstep, "-o", tmp_path / "run.log").stdout
    with can.LogReader(lockstep / "bus.blf") as reader:
        assert output.startswith(f"{tmp_path / 'run.log'}: {len(list(reader))} frames; starts")
    with pytest.raises(ConfigError, match="candump knows frames alone"):
        run(lockstep / "truth.npz", "-o", tmp_path / "truth.log")


def test_a_log_that_is_cut_short_is_exported_with_a_warning(lockstep: Path, tmp_path: Path) -> None:
    cut = tmp_path / "cut.blf"
    content = (lockstep / "bus.blf").read_bytes()
    cut.write_bytes(content[: len(content) // 2])
    result = run(cut, "-o", tmp_path / "saved.csv", "--json")
    told = json.loads(result.stdout)
    assert result.return_value == INCOMPLETE
    assert f"tcs-hil: warning: {told['lost']}\n" in result.stderr
    assert f"{cut}: is cut short: {told['frames']} frames were read" in told["lost"]
    assert f"# lost: {told['lost']}" in (tmp_path / "saved.csv").read_text()


def test_a_whole_run_loses_nothing(lockstep: Path, tmp_path: Path) -> None:
    result = run(lockstep, "-o", tmp_path / "run.csv", "--json")
    assert (result.return_value, json.loads(result.stdout)["lost"]) == (0, "")
    assert "warning" not in result.stderr


def test_a_dbc_without_a_log_to_decode_is_refused(lockstep: Path, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"--dbc my\.dbc: there is no bus log"):
        run(lockstep / "truth.npz", "--dbc", "my.dbc", "-o", tmp_path / "run.csv")


def test_a_bad_suffix_is_refused_before_anything_is_read(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="suffix must be one of"):
        run(tmp_path / "nowhere", "-o", tmp_path / "run.xlsx")
