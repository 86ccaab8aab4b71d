"""What the recorder may do to files that are already there."""

import contextlib
import os
from pathlib import Path

import pytest

from tcs_hil.runtime.recorder import FlightRecorder
from tcs_hil.runtime.recording import RecordingError, RunInfo, read

INFO = RunInfo(
    period_ns=2_000_000,
    started_monotonic_ns=0,
    started_realtime_ns=0,
    controller="pi",
    bus="embedded vcan0",
    machine="test",
)


def test_a_file_that_is_no_recording_is_left_alone(tmp_path: Path) -> None:
    notes = tmp_path / "notes.txt"
    notes.write_text("dear diary")
    with pytest.raises(RecordingError, match=r"notes\.txt: exists and is not a flight recording"):
        FlightRecorder(notes, INFO, 10)
    assert notes.read_text() == "dear diary"


def test_a_directory_is_left_alone(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="exists and is not a flight recording"):
        FlightRecorder(tmp_path, INFO, 10)
    assert tmp_path.is_dir()


def test_a_pipe_is_left_alone(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pytest.raises(RecordingError, match="exists and is not a flight recording"):
        FlightRecorder(pipe, INFO, 10)
    assert pipe.is_fifo()


def test_a_recording_survives_when_it_cannot_be_put_aside(tmp_path: Path) -> None:
    path = tmp_path / "flight.tcsrec"
    FlightRecorder(path, INFO, 10).close()
    (tmp_path / "flight.tcsrec.previous" / "in the way").mkdir(parents=True)
    with pytest.raises(RecordingError, match=r"flight\.tcsrec"):
        FlightRecorder(path, INFO, 10)
    assert path.exists()


def test_a_path_below_a_file_is_refused_in_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(RecordingError, match="Not a directory"):
        FlightRecorder(tmp_path / "file" / "flight.tcsrec", INFO, 10)


def test_whatever_byte_of_the_header_is_damaged_it_is_at_most_refused(tmp_path: Path) -> None:
    path = tmp_path / "flight.tcsrec"
    FlightRecorder(path, INFO, 3).close()
    whole = path.read_bytes()
    for position in range(0, 600):
        path.write_bytes(whole[:position] + b"\xb0" + whole[position + 1 :])
        with contextlib.suppress(RecordingError):  # anything else would end the test
            read(path)
