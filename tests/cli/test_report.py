"""`tcs-hil report`, as its user and as a program reads it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from msgspec.structs import replace
from runtime.fakes import PERIOD_NS, RUN, insight, made_pass

from tcs_hil.canbus.frame import PortCounters
from tcs_hil.cli.report import command
from tcs_hil.runtime.record import record
from tcs_hil.runtime.recorder import FlightRecorder
from tcs_hil.signals import BusCondition

TICKS = 20


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """Twenty quiet ticks, the eighth of which sent 500 µs later than the others."""
    path = tmp_path / "flight"
    with FlightRecorder(path, RUN, 100) as recorder:
        for number in range(TICKS):
            sent_us = 590 if number == 7 else 90
            made = made_pass(number, sent_us=sent_us, scheduled_ns=(number + 1) * PERIOD_NS)
            recorder.write(record(made, insight(wheel_stamp_ns=number * PERIOD_NS)))
    return path


def report(*arguments: object) -> Result:
    result = CliRunner().invoke(command, [str(argument) for argument in arguments])
    assert result.exit_code == 0, result.output
    return result


def test_the_table_names_the_run_and_what_was_lost(recording: Path) -> None:
    output = report(recording).output
    assert output.startswith("nmpc (python) on virtual:test, a test\n")
    assert "lost frames 4, E2E errors 5" in " ".join(output.split())


def test_a_bus_that_was_never_understood_is_told_with_its_likely_cause(tmp_path: Path) -> None:
    made = made_pass()
    deaf = replace(made, measurement=replace(made.measurement, bus=BusCondition.ERROR_PASSIVE))
    with FlightRecorder(tmp_path / "flight", RUN, 100) as recorder:
        recorder.write(record(deaf, replace(insight(), counters=PortCounters(error_frames=200))))
    assert "bit rate mismatch?" in report(tmp_path / "flight").output


def test_the_worst_ticks_are_listed_only_when_asked_for(recording: Path) -> None:
    assert "worst" not in json.loads(report(recording, "--json").output)
    (tick,) = json.loads(report(recording, "--worst", 1, "--json").output)["worst"]
    assert (tick["number"], tick["culprit"]) == (7, "send")
    assert tick["response_us"] == pytest.approx(590)


def test_the_table_of_the_worst_shows_every_stage(recording: Path) -> None:
    output = report(recording, "--worst", 3).output
    assert "the slowest ticks" in output
    (slow,) = (line for line in output.splitlines() if "540*" in line)
    assert " ".join(slow.split()) == "0.014 7 590 10 10 0 0 30 540* 4 0 3/4 ACTIVE"


def test_the_tables_fit_a_terminal_of_eighty_columns(recording: Path) -> None:
    output = report(recording, "--worst", 3).output
    assert "…" not in output


def test_a_histogram_is_written_for_every_time_that_occurred(
    recording: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "new" / "folder"
    report(recording, "--histograms", folder)
    assert {path.name for path in folder.iterdir()} == {
        f"{name}.hgrm"
        for name in (
            *("wake_jitter", "receive", "step", "send", "total"),
            *("latency", "solve", "input_age"),
        )
    }
    assert f"Total count    = {TICKS:12d}" in (folder / "total.hgrm").read_text()


def test_a_folder_that_cannot_be_made_is_one_sentence(recording: Path) -> None:
    result = CliRunner().invoke(command, [str(recording), "--histograms", f"{recording}/below"])
    assert "cannot be written" in str(result.exception)
