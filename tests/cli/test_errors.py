"""Every mistake of the user: one sentence on stderr, exit status 2, no traceback."""

import importlib
from collections.abc import Iterator
from pathlib import Path

import click
import pytest
from cli.ended import TcsHil

from tcs_hil import cli
from tcs_hil.model.dataset import DatasetSettings
from tcs_hil.model.edmd import IdentificationSettings, identify

SMALL = DatasetSettings(trajectories=20, samples=20, period_s=0.001)


def options() -> Iterator[tuple[str, click.Parameter]]:
    """Every option of every command, with the command's name."""
    for name in cli.COMMANDS:
        command = importlib.import_module(f"tcs_hil.cli.{name}").command
        for parameter in command.params:
            if isinstance(parameter, click.Option):
                yield name, parameter


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
        (("run", "--channel", "can77", "--priority=0"), "tick.priority"),
        (("run", "--channel", "can77", "--spin-us=5000"), "tick.spin_us"),
        (("run", "--channel", "can77", "--cpu=-1"), "tick.cpu"),
        (("bench", "--only", "warp"), "controllers, tick, scaling, bus, start"),
        (("run", "--interface", "telepathy"), "telepathy"),
        (("run", "--model", "nowhere.npz"), "nowhere.npz"),
        (("report", "nowhere.tcsrec"), "nowhere.tcsrec"),
        (("record", "drive.mp3"), "drive.mp3"),
        (("identify", "--output", "no/such/folder/model.npz"), "no/such/folder/model.npz"),
        (("identify", "--output", ""), "is a folder"),
        (
            ("run", "--interface", "embedded", "--bitrate", "500000"),
            "bitrate 500000: has no effect",
        ),
    ],
)
def test_a_bad_command_line_is_refused_in_one_sentence(
    tcs_hil: TcsHil,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    arguments: tuple[str, ...],
    culprit: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert tcs_hil(*arguments).is_one_sentence_about(culprit)


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
    tcs_hil: TcsHil, bad_files: dict[str, Path], name: str, culprit: str
) -> None:
    assert tcs_hil("run", "--config", str(bad_files[name])).is_one_sentence_about(culprit)


def test_a_model_for_another_sampling_time_is_refused(tcs_hil: TcsHil, other_period: Path) -> None:
    refusal = tcs_hil("run", "--preset", "paper", "--model", str(other_period))
    assert refusal.is_one_sentence_about("fast.npz", "0.001")


@pytest.mark.parametrize("text", ["nan", "inf"])
def test_a_number_that_is_none_is_refused_wherever_one_is_asked_for(
    tcs_hil: TcsHil, text: str
) -> None:
    asked = [each for each in options() if isinstance(each[1].type, click.types.FloatParamType)]
    assert asked
    for command, option in asked:
        assert tcs_hil(command, option.opts[0], text).is_one_sentence_about(option.opts[0], text)


def test_an_empty_name_of_a_bus_is_refused_in_every_command(tcs_hil: TcsHil) -> None:
    asked = [each for each in options() if each[1].name in ("interface", "channel")]
    assert len(asked) > len(("interface", "channel"))
    for command, option in asked:
        assert tcs_hil(command, option.opts[0], " ").is_one_sentence_about(option.opts[0], "empty")


@pytest.mark.parametrize("name", list(cli.COMMANDS))
def test_every_command_explains_itself_with_an_example(tcs_hil: TcsHil, name: str) -> None:
    ended = tcs_hil(name, "--help")
    assert ended.status == 0
    assert f"tcs-hil {name}" in ended.out.partition("Example:")[2]


def test_the_list_of_commands_is_shown_without_arguments(tcs_hil: TcsHil) -> None:
    ended = tcs_hil()
    assert ended.status == 2
    assert all(name in ended.err for name in cli.COMMANDS)


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
    tcs_hil: TcsHil, tmp_path: Path, text: str, culprit: str
) -> None:
    settings, output = tmp_path / "identify.toml", tmp_path / "model.npz"
    settings.write_text(text)
    identified = ("--preset", "paper", "--settings", str(settings), "--output", str(output))
    assert tcs_hil("identify", *identified).is_one_sentence_about(culprit)
    assert not output.exists()
