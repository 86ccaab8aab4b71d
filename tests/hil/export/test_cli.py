"""``tcs-hil export`` as it is called."""

from pathlib import Path

import pytest
from click.testing import CliRunner
from hil.logs.made_run import TICKS

from tcs_hil.cli.export import command
from tcs_hil.errors import ConfigError


def run(*arguments: object) -> str:
    runner = CliRunner(catch_exceptions=False)
    return runner.invoke(command, list(map(str, arguments)), standalone_mode=False).stdout


def test_a_run_s_folder_becomes_a_file(lockstep: Path, tmp_path: Path) -> None:
    output = run(lockstep, "-o", tmp_path / "run.csv")
    assert (tmp_path / "run.csv").exists()
    assert f"{tmp_path / 'run.csv'}: " in output
    assert "11 sources" in output
    assert "starts 2026-09-21T14:13:20" in output


def test_parts_of_a_run_can_be_left_out(lockstep: Path, tmp_path: Path) -> None:
    output = run(lockstep / "truth.npz", "-o", tmp_path / "run.csv")
    assert f"{TICKS} samples of 1 sources, 0 frames" in output


def test_a_bad_suffix_is_refused_before_anything_is_read(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="suffix must be one of"):
        run(tmp_path / "nowhere", "-o", tmp_path / "run.xlsx")
