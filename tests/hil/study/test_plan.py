"""A study's file: paths in it are relative to it."""

from pathlib import Path

import pytest

from tcs_hil.errors import ConfigError
from tcs_hil.hil.study.plan import read_plan

SCENARIO = 'description = "mine"\nduration_s = 1.0\ndriver = { request = [[0.0, 1.0]] }\n'
STUDY = """
scenario = "{scenario}"
service = {{ model = "bank.npz" }}
vary = [{{ key = "road.0.mu", values = [0.3] }}]
"""


def study(folder: Path, scenario: str) -> Path:
    (folder / "cars").mkdir()
    (folder / "cars" / "mine.toml").write_text(SCENARIO)
    path = folder / "study.toml"
    path.write_text(STUDY.format(scenario=scenario))
    return path


def test_scenario_and_model_are_found_beside_the_study(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = study(tmp_path, "cars/mine.toml")
    monkeypatch.chdir("/")
    plan = read_plan(path)
    assert plan.scenario.description == "mine"
    assert plan.study.service.model == str(tmp_path / "bank.npz")


def test_a_shipped_scenario_needs_no_path(tmp_path: Path) -> None:
    assert read_plan(study(tmp_path, "manoeuvre-1")).scenario.duration_s == 3.0


def test_the_working_directory_is_no_place_to_look(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = study(tmp_path, "mine.toml")
    monkeypatch.chdir(tmp_path / "cars")
    with pytest.raises(ConfigError, match=f"{tmp_path / 'mine.toml'}: cannot be read"):
        read_plan(path)
