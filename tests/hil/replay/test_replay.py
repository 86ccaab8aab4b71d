"""Whole replays, from files to verdict."""

import json
import uuid
from pathlib import Path

import can
import pytest
from click.testing import CliRunner, Result
from msgspec.structs import replace

from plant_emulator.scenario import load_scenario
from tcs_hil.cli.damage import INCOMPLETE
from tcs_hil.cli.replay import command
from tcs_hil.control.settings import ControlSettings
from tcs_hil.errors import ConfigError
from tcs_hil.hil.logs.sources import find_sources
from tcs_hil.hil.processes.program import program
from tcs_hil.hil.replay.recorded import Grid
from tcs_hil.hil.replay.session import recorded_config, replay_in_process
from tcs_hil.hil.run import RunPlan, execute
from tcs_hil.service.settings import BusSettings, ServiceConfig

LIMIT = 0x090


def run(*arguments: object) -> Result:
    return CliRunner(catch_exceptions=False).invoke(
        command, list(map(str, arguments)), standalone_mode=False
    )


def rewritten(log: Path, to: Path, change: dict[int, bytes]) -> Path:
    """The same log in another file, with other data in the frames at some places."""
    with can.LogReader(log) as reader, can.Logger(str(to)) as write:
        for place, message in enumerate(reader):
            message.data = bytearray(change.get(place, bytes(message.data)))
            write(message)
    return to


def test_the_command_says_that_nothing_differs(kept: Path) -> None:
    result = run(kept)
    assert result.return_value == 0
    assert "600 ticks compared, found by the bench's ticks; 0 differ" in result.output


def test_another_law_is_told_from_the_recorded_one_with_status_1(kept: Path) -> None:
    result = run(kept, "--controller", "off")
    assert result.return_value == 1
    assert "recorded under PI, replayed under OFF" in result.output
    assert "493 differ; never both set a torque limit" in result.output
    assert "tick 67, 0.134 s: TorqueLimitL was 132.75, is no limit" in result.output
    assert "TcsController was" not in result.output
    assert "what was on the bus before" in result.output


def test_for_a_program_the_first_difference_comes_as_json(kept: Path) -> None:
    result = run(kept, "--controller", "off", "--json")
    told = json.loads(result.stdout)
    assert (told["grid"], told["ticks"]) == ("bench", 600)
    assert told["other_law"] == {"recorded": "PI", "replayed": "OFF"}
    assert (told["largest_nm"], told["lost"]) == (None, "")
    assert told["first"][0] == {
        "tick": 67,
        "time_s": 0.134,
        "signal": "TorqueLimitL",
        "recorded": 132.75,
        "replayed": "no limit",
    }


def test_of_a_log_cut_short_the_rest_is_compared_and_the_loss_said(
    kept: Path, tmp_path: Path
) -> None:
    cut = tmp_path / "cut.blf"
    cut.write_bytes((kept / "bus.blf").read_bytes()[:20_000])
    result = run(cut, "--config", kept / "service.toml", "--json")
    told = json.loads(result.stdout)
    assert result.return_value == INCOMPLETE
    assert 0 < told["ticks"] < 600
    assert told["differing"] == 0
    assert f"tcs-hil: warning: {cut}: is cut short" in result.stderr
    assert told["lost"] in result.stderr


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (("--channel", "vcan0"), "--channel: has no effect here; only --live needs a bus"),
        (("--live", "--controller", "pi"), "--controller: has no effect here; the running"),
    ],
)
def test_an_option_without_effect_is_refused(
    kept: Path, options: tuple[str, ...], complaint: str
) -> None:
    with pytest.raises(ConfigError, match=complaint):
        run(kept, *options)


def test_one_bit_of_one_recorded_limit_is_found(kept: Path, tmp_path: Path) -> None:
    log = kept / "bus.blf"
    with can.LogReader(log) as reader:
        limits = [(n, bytes(m.data)) for n, m in enumerate(reader) if m.arbitration_id == LIMIT]
    place, data = limits[500]
    changed = rewritten(
        log, tmp_path / "bus.blf", {place: data[:2] + bytes([data[2] ^ 1]) + data[3:]}
    )
    sources = find_sources(
        [
            changed,
        ]
    )
    verdict = replay_in_process(sources, recorded_config(find_sources([kept])), 0.0)
    (difference,) = verdict.comparison.first
    assert (difference.place, difference.signal.name) == (500, "TorqueLimitL")
    assert verdict.comparison.differing == 1
    assert verdict.comparison.largest_nm == pytest.approx(0.05)


@pytest.mark.parametrize("suffix", [".asc", ".log"])
def test_the_format_of_the_log_makes_no_difference(kept: Path, tmp_path: Path, suffix: str) -> None:
    log = rewritten(kept / "bus.blf", tmp_path / f"bus{suffix}", {})
    assert run(log, "--config", kept / "service.toml").return_value == 0


def test_a_run_in_real_time_is_reproduced_however_slow_the_machine_was(tmp_path: Path) -> None:
    scenario = replace(load_scenario("manoeuvre-1"), duration_s=0.5)
    config = ServiceConfig(
        controller="pi",
        bus=BusSettings(interface="embedded", channel=f"vcan-{uuid.uuid4().hex[:8]}"),
        control=ControlSettings(preset="paper"),
    )
    files = execute(RunPlan(scenario, config, "real-time", tmp_path / "run"))
    sources = find_sources([files.folder])
    verdict = replay_in_process(sources, recorded_config(sources), 0.0)
    assert verdict.grid is Grid.FLIGHT
    assert verdict.comparison.ticks == len(files.read_flight())
    assert verdict.comparison.same


def test_without_its_flight_recording_the_limits_tell_the_ticks(tmp_path: Path, kept: Path) -> None:
    bench = (0x7F0, 0x7F1)
    log = tmp_path / "bus.log"
    with can.LogReader(kept / "bus.blf") as reader, can.Logger(str(log)) as write:
        for place, message in enumerate(m for m in reader if m.arbitration_id not in bench):
            message.timestamp += 1e-5 * place / 10  # on a bus no two come at once
            write(message)
    config = recorded_config(find_sources([kept]))
    verdict = replay_in_process(find_sources([log]), config, 0.0)
    assert verdict.grid is Grid.LIMITS
    assert verdict.comparison.same


def test_live_a_running_service_gives_the_same_answers(kept: Path, tmp_path: Path) -> None:
    channel = f"vcan-{uuid.uuid4().hex[:8]}"
    bus = ("--interface", "embedded", "--channel", channel)
    service = ("tcs_hil", "run", "--config", str(kept / "service.toml"), "--trigger", "lockstep")
    with program(*service, *bus, log=tmp_path / "service.log"):
        result = run(kept, "--live", *bus)
    assert result.return_value == 0, result.output
    assert "600 ticks compared" in result.output


def test_live_another_law_is_told_from_the_recorded_one(kept: Path, tmp_path: Path) -> None:
    channel = f"vcan-{uuid.uuid4().hex[:8]}"
    bus = ("--interface", "embedded", "--channel", channel)
    service = ("tcs_hil", "run", "--controller", "off", "--trigger", "lockstep")
    with program(*service, *bus, log=tmp_path / "service.log"):
        result = run(kept, "--live", *bus)
    assert result.return_value == 1
    assert "TcsController was PI, is OFF" in result.output


def test_a_replay_needs_a_log(tmp_path: Path) -> None:
    (tmp_path / "flight").write_bytes(b"TCSFLREC")
    with pytest.raises(ConfigError, match="needs the bus log"):
        replay_in_process(find_sources([tmp_path / "flight"]), ServiceConfig(), 0.0)


def test_a_log_in_which_nobody_is_answered_is_refused_by_name(tmp_path: Path) -> None:
    log = tmp_path / "drive.log"
    log.write_text("(1700000000.000000) can0 0A2#0000000000000000\n")
    with pytest.raises(ConfigError, match=r"drive\.log: holds no vehicle and service"):
        replay_in_process(find_sources([log]), ServiceConfig(), 0.0)
