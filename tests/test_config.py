from pathlib import Path
from typing import Literal

import msgspec
import pytest

from tcs_hil.config import convert, read_toml
from tcs_hil.errors import ConfigError
from tcs_hil.safety_settings import GateSettings


def write(folder: Path, text: str) -> Path:
    path = folder / "gate.toml"
    path.write_text(text)
    return path


def test_a_good_file_becomes_a_frozen_struct(tmp_path: Path) -> None:
    settings = read_toml(write(tmp_path, "release_rate_nmps = 300.0"), GateSettings)
    assert settings == GateSettings(release_rate_nmps=300.0)


@pytest.mark.parametrize(
    ("text", "culprit"),
    [
        ("release_rate = 1.0", "release_rate"),
        ("release_rate_nmps = -1.0", "release_rate_nmps"),
        ("release_rate_nmps = 'fast'", "release_rate_nmps"),
        ("release_rate_nmps = ", "not valid TOML"),
        (f"release_rate_nmps = {'9' * 5000}", "not valid TOML"),
        (f"release_rate_nmps = {'[' * 20_000}{']' * 20_000}", "nested too deeply"),
        (f"'{'x' * 30}{'é' * 5000}' = 1", "unknown|utf-8"),
    ],
)
def test_a_bad_file_is_refused_with_file_and_key_named(
    tmp_path: Path, text: str, culprit: str
) -> None:
    path = write(tmp_path, text)
    with pytest.raises(ConfigError, match=culprit) as refused:
        read_toml(path, GateSettings)
    assert str(path) in str(refused.value)
    assert "\n" not in str(refused.value)


class Choice(msgspec.Struct, forbid_unknown_fields=True):
    colour: Literal["red", "green"] = "red"


class Nested(msgspec.Struct, forbid_unknown_fields=True):
    choice: Choice | None = None
    choices: tuple[Choice, ...] = ()
    named: dict[str, Choice] = {}


@pytest.mark.parametrize(
    ("table", "sentence"),
    [
        ({"chioce": 1}, "unknown key `chioce`; did you mean choice or choices?"),
        ({"choice": {"x": 1}}, "choice: unknown key `x`; there are colour"),
        ({"choice": {"colour": "gren"}}, "unknown value 'gren'; did you mean green?"),
        ({"choices": [{}, {"colour": "x"}]}, "choices[1].colour: unknown value 'x'; there are"),
        (
            {"named": {"mine": {"colou": 1}}},
            "named[...]: unknown key `colou`; did you mean colour?",
        ),
        ({"choice": 1}, "choice: Expected `object`, got `int`"),
    ],
)
def test_an_unknown_name_is_refused_with_what_may_be_meant(table: object, sentence: str) -> None:
    with pytest.raises(ConfigError) as refused:
        convert(table, Nested, "mine.toml")
    assert sentence in str(refused.value)


def test_a_name_no_file_can_have_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="cannot be read"):
        read_toml(tmp_path / "gate\0.toml", GateSettings)


def test_a_missing_file_is_refused_by_name(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"nowhere\.toml: cannot be read"):
        read_toml(tmp_path / "nowhere.toml", GateSettings)
