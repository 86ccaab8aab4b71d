"""`tcs-hil map`, as its user and as a program reads it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from tcs_hil.cli.map import command

FOLDER = Path("tests/data/dbc")


def check(*arguments: object) -> Result:
    return CliRunner().invoke(command, ["check", *(str(argument) for argument in arguments)])


@pytest.fixture
def broken(tmp_path: Path) -> Path:
    """A map with a signal misspelt and a message that comes slowly."""
    text = (FOLDER / "montane.toml").read_text()
    path = tmp_path / "broken.toml"
    path.write_text(
        text.replace("montane.dbc", str((FOLDER / "montane.dbc").absolute()))
        .replace("WhlSpd_Frnt.WhlSpd_FL", "WhlSpd_Frnt.WhlSpeed_FL")
        .replace("[map.messages.VCU_Demand]", "[map.messages.VCU_Demand]\ncycle_ms = 50")
    )
    return path


def test_a_good_map_is_shown_with_what_every_signal_becomes() -> None:
    result = check(FOLDER / "quendal.toml")
    assert result.exit_code == 0
    lines = result.output.splitlines()
    assert lines[0] == (
        "read     wheel_speed_fl: WHL_DATA.WHL_VL in km/h, steps of 0.00655 rad/s, every 1 ms, "
        "while WHL_Page is 1 and raw is not 32766, 32767"
    )
    assert "sent     limits.left: TCU_LIM.TCU_MaxL, every 2 ms" in lines
    assert any(line.startswith("warning  inputs: no motor speeds and torques") for line in lines)
    assert lines[-1] == "The service can run with this map."


def test_a_bad_map_is_explained_errors_first_and_ends_with_status_1(broken: Path) -> None:
    result = check(broken)
    assert result.exit_code == 1
    sentences = [line for line in result.output.splitlines() if line.startswith(("err", "war"))]
    assert sentences[0].startswith("error    inputs.wheel_speed_fl: message ABS_WhlSpd_Frnt has")
    assert "near it: WhlSpd_FL" in sentences[0]
    assert sentences[1].startswith("warning  messages.VCU_Demand: brings its values every 50 ms")
    assert result.output.endswith("The service cannot run with it.\n")


def test_a_program_reads_the_same_as_json(broken: Path) -> None:
    result = check(broken, "--json")
    assert result.exit_code == 1
    table = json.loads(result.output)
    assert table["runs"] is False
    assert {row["input"] for row in table["inputs"]} >= {"wheel_speed_fr", "accel_x"}
    assert "wheel_speed_fl" not in {row["input"] for row in table["inputs"]}
    weights = [finding["weight"] for finding in table["findings"]]
    assert weights.count("error") == 1
    montane = json.loads(check(FOLDER / "montane.toml", "--json").output)
    assert montane["runs"] is True
    speed = next(row for row in montane["inputs"] if row["input"] == "wheel_speed_fl")
    assert speed["signal"] == "ABS_WhlSpd_Frnt.WhlSpd_FL"
    assert speed["believed"] == "while WhlSpd_FL_Stat is 0"
    assert speed["cycle"] == "2 ms"


@pytest.mark.parametrize("given", ["aurelis.dbc", "cars/aurelis.dbc"])
def test_a_proposal_is_good_beside_the_dbc_or_anywhere(
    given: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    content = (FOLDER / "aurelis.dbc").read_bytes()
    monkeypatch.chdir(tmp_path)
    Path(given).parent.mkdir(exist_ok=True)
    Path(given).write_bytes(content)
    proposal = CliRunner().invoke(command, ["init", given]).stdout
    beside = Path(given).with_suffix(".toml")
    beside.write_text(proposal)
    monkeypatch.chdir("/")
    assert check(tmp_path / beside).exit_code == 0
