"""Every mistake of the user: one sentence on stderr, exit status 2, no traceback."""

import sys
from pathlib import Path

import pytest

from tcs_hil import cli
from tcs_hil.model.dataset import DatasetSettings
from tcs_hil.model.edmd import IdentificationSettings, identify

SMALL = DatasetSettings(trajectories=20, samples=20, period_s=0.001)


def run(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture, *arguments: str):
    monkeypatch.setattr(sys, "argv", ["tcs-hil", *arguments])
    with pytest.raises(SystemExit) as end:
        cli.main()
    output = capsys.readouterr()
    return end.value.code, output.out, output.err


@pytest.fixture
def other_period(tmp_path: Path) -> Path:
    path = tmp_path / "fast.npz"
    identify(IdentificationSettings(dataset=SMALL)).save(path)
    return path


@pytest.fixture
def bad_files(tmp_path: Path) -> dict[str, Path]:
    texts = {
        "unknown key": "[bus]\nchanel = 'vcan0'",
        "no TOML": "[bus",
        "out of bounds": "[tick]\nphase_us = -1",
        "no DBC": "[bus]\ndatabase = 'nowhere.dbc'",
        "bad DBC": f"[bus]\ndatabase = '{tmp_path / 'bad.dbc'}'",
        "no model": "model = 'nowhere.npz'",
        "no model file": f"model = '{tmp_path / 'bad.dbc'}'",
    }
    (tmp_path / "bad.dbc").write_text("this is no DBC")
    paths = {}
    for name, text in texts.items():
        paths[name] = tmp_path / f"{name.replace(' ', '-')}.toml"
        paths[name].write_text(text)
    return paths


@pytest.mark.parametrize(
    ("arguments", "culprit"),
    [
        (("fly",), "fly"),
        (("run", "--colour", "red"), "--colour"),
        (("run", "--controller", "lqr"), "lqr"),
        (("run", "--config", "nowhere.toml"), "nowhere.toml"),
        (("run", "--phase-us", "-1"), "phase_us"),
        (("run", "--channel", "can77"), "can77"),
        (("run", "--interface", "telepathy"), "telepathy"),
        (("run", "--model", "nowhere.npz"), "nowhere.npz"),
        (("report", "nowhere.tcsrec"), "nowhere.tcsrec"),
        (("record", "drive.mp3"), "drive.mp3"),
        (("identify", "--output", "no/such/folder/model.npz"), "no/such/folder/model.npz"),
    ],
)
def test_a_bad_command_line_is_refused_in_one_sentence(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture,
    tmp_path: Path,
    arguments: tuple[str, ...],
    culprit: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    status, _, error = run(monkeypatch, capsys, *arguments)
    assert status == 2
    assert error.startswith("tcs-hil: error: ")
    assert culprit in error
    assert error.count("\n") == 1


@pytest.mark.parametrize(
    ("name", "culprit"),
    [
        ("unknown key", "chanel"),
        ("no TOML", "not valid TOML"),
        ("out of bounds", "phase_us"),
        ("no DBC", "nowhere.dbc"),
        ("bad DBC", "bad.dbc"),
        ("no model", "nowhere.npz"),
        ("no model file", "bad.dbc"),
    ],
)
def test_a_bad_configuration_is_refused_in_one_sentence(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture,
    bad_files: dict[str, Path],
    name: str,
    culprit: str,
) -> None:
    status, _, error = run(monkeypatch, capsys, "run", "--config", str(bad_files[name]))
    assert status == 2
    assert culprit in error
    assert error.count("\n") == 1


def test_a_model_for_another_sampling_time_is_refused(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture, other_period: Path
) -> None:
    status, _, error = run(
        monkeypatch, capsys, "run", "--preset", "paper", "--model", str(other_period)
    )
    assert status == 2
    assert "fast.npz" in error
    assert "0.001" in error


@pytest.mark.parametrize("name", list(cli.COMMANDS))
def test_every_command_explains_itself_with_an_example(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture, name: str
) -> None:
    status, output, _ = run(monkeypatch, capsys, name, "--help")
    assert status == 0
    assert f"tcs-hil {name}" in output.partition("Example:")[2]


def test_the_list_of_commands_is_shown_without_arguments(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture
) -> None:
    status, _, error = run(monkeypatch, capsys)
    assert status == 2
    assert all(name in error for name in cli.COMMANDS)


@pytest.mark.parametrize(
    ("text", "culprit"),
    [
        ("[dataset]\nperiod_s = 1e9", "dataset.period_s"),
        ("[dataset]\ntorque_nm = [0.0, 1e300]", "dataset.torque_nm"),
        ("[dataset]\ninitial_speed_mps = [0.0, inf]", "dataset.initial_speed_mps"),
        ("[dataset]\ntrajectories = 1000000000", "dataset.trajectories"),
        ("[vehicle]\nmass_kg = inf", "vehicle.mass_kg"),
    ],
)
def test_numbers_beyond_any_car_are_refused_before_the_work(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture,
    tmp_path: Path,
    text: str,
    culprit: str,
) -> None:
    settings = tmp_path / "identify.toml"
    settings.write_text(text)
    status, _, error = run(
        *(monkeypatch, capsys, "identify", "--preset", "paper"),
        *("--settings", str(settings), "--output", str(tmp_path / "model.npz")),
    )
    assert status == 2
    assert culprit in error
    assert not (tmp_path / "model.npz").exists()
