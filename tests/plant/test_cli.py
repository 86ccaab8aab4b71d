"""The command line, as a user meets it."""

import json
import sys

import pytest

from plant_emulator.cli import main


@pytest.fixture
def invoke(monkeypatch, capsys):
    """Run the command line; gives status, stdout and stderr."""

    def run(*arguments):
        monkeypatch.setattr(sys, "argv", ["plant-emulator", *arguments])
        try:
            main()
        except SystemExit as done:
            status = done.code or 0
        else:
            status = 0
        return status, *capsys.readouterr()

    return run


LOCKSTEP = ("run", "--scenario", "manoeuvre-1", "--mode", "lockstep")
SHORT = """
description = "a tenth of a second"
duration_s = 0.1
[vehicle]
variant = "quarter-car"
[[road]]
mu = 0.3
[driver]
request = [[0.0, 50.0]]
"""


def test_a_scenario_runs_in_real_time_and_ends_well(invoke, tmp_path, channel):
    path = tmp_path / "short.toml"
    path.write_text(SHORT)
    record = tmp_path / "truth.npz"
    bus = ("--interface", "embedded", "--channel", channel)
    status, out, err = invoke(
        "run", "--scenario", str(path), *bus, "--record", str(record), "--json"
    )
    assert status == 0
    assert json.loads(out)["time_s"] == pytest.approx(0.1)
    assert "embedded" in err
    assert record.exists()


def test_list_names_the_shipped_scenarios(invoke):
    status, out, _ = invoke("list")
    assert status == 0
    assert "manoeuvre-1  " in out


def test_list_speaks_json(invoke):
    _, out, _ = invoke("list", "--json")
    assert {"manoeuvre-1", "manoeuvre-2"} <= {entry["name"] for entry in json.loads(out)}


@pytest.mark.parametrize("command", ["run", "list"])
def test_help_shows_an_example(invoke, command):
    status, out, _ = invoke(command, "--help")
    assert status == 0
    assert f"plant-emulator {command}" in out.partition("Example:")[2]


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("run",), "--scenario"),
        (("run", "--scenario", "nonsense"), "nonsense"),
        (("run", "--scenario", "manoeuvre-1", "--vehicle", "boat"), "--vehicle"),
        (("run", "--scenario", "manoeuvre-1", "--interface", "carrier-pigeon"), "carrier-pigeon"),
        (("run", "--scenario", "manoeuvre-1", "--record", "/nowhere/truth.npz"), "/nowhere"),
        (("run", "--scenario", "manoeuvre-1", "--channel", ""), "'--channel': is empty"),
        ((*LOCKSTEP, "--phase-us", "0"), "--phase-us: has no effect here; in lockstep"),
        (("run", "--wings"), "--wings"),
        (("fly",), "fly"),
    ],
)
def test_a_users_mistake_is_one_sentence_and_status_2(invoke, arguments, named):
    status, out, err = invoke(*arguments)
    assert status == 2
    assert out == ""
    assert err.startswith("plant-emulator: error: ")
    assert named in err
    assert err.count("\n") == 1
