"""The flight recorder: what is written is read, whatever happens to the writer."""

from __future__ import annotations

import errno
import math
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace
from runtime.fakes import PERIOD_NS, RUN, insight, made_pass, numbered

from tcs_hil.control.protocol import SolveStatus
from tcs_hil.runtime.record import FIELDS, NO_LATENCY, PACKER, record
from tcs_hil.runtime.recorder import FlightRecorder
from tcs_hil.runtime.recording import PREAMBLE, RecordingError, read, read_info, read_on
from tcs_hil.signals import BusCondition, ControllerKind, Suspect, TcsState


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "flight.rec"


def write(path: Path, ticks: int, capacity: int) -> None:
    with FlightRecorder(path, RUN, capacity) as recorder:
        for number in range(ticks):
            recorder.write(numbered(number))


def test_every_field_comes_back_under_its_own_name(path: Path) -> None:
    made = made_pass(9, sent_us=90)
    with FlightRecorder(path, RUN, 4) as recorder:
        recorder.write(record(made, insight(wheel_stamp_ns=PERIOD_NS - 5_000)))
    (tick,) = read(path)
    expected = {
        "number": 9,
        "scheduled_ns": PERIOD_NS,
        "wake_ns": PERIOD_NS + 10_000,
        "received_ns": PERIOD_NS + 20_000,
        "stepped_ns": PERIOD_NS + 50_000,
        "sent_ns": PERIOD_NS + 90_000,
        "now_ns": PERIOD_NS + 10_000,
        "wheel_stamp_ns": PERIOD_NS - 5_000,
        "latency_ns": 95_000,
        "solve_fl_ns": 81,
        "solve_fr_ns": 82,
        "skipped": 0,
        "frames": 4,
        "rx_frames": 101,
        "tx_frames": 102,
        "bus_errors": 6,
        "lost_frames": 4,
        "e2e_errors": 5,
        "e2e_repeated": 6,
        "e2e_wrong_sequence": 7,
        "iterations_fl": 3,
        "iterations_fr": 4,
        "front_speed_age_s": 0.001,
        "rear_speed_age_s": 0.002,
        "motor_age_s": 0.003,
        "driver_age_s": math.inf,
        "vehicle_speed_mps": 7.0,
        "wheel_speed_fl_radps": 11.0,
        "wheel_speed_fr_radps": 12.0,
        "wheel_speed_rl_radps": 13.0,
        "wheel_speed_rr_radps": 14.0,
        "slip_ratio_fl": 0.1,
        "slip_ratio_fr": 0.2,
        "driver_torque_fl_nm": 51.0,
        "driver_torque_fr_nm": 52.0,
        "motor_torque_fl_nm": 41.0,
        "motor_torque_fr_nm": 42.0,
        "motor_speed_fl_radps": 31.0,
        "motor_speed_fr_radps": 32.0,
        "proposal_fl_nm": 71.0,
        "proposal_fr_nm": 72.0,
        "limit_fl_nm": 61.0,
        "limit_fr_nm": math.inf,
        "status_fl": SolveStatus.OK,
        "status_fr": SolveStatus.OK,
        "state": TcsState.ACTIVE,
        "fault_code": 0,
        "controller": ControllerKind.NMPC,
        "bus_condition": BusCondition.SEND_FAILED,
        "suspects": Suspect.WHEEL_RL | Suspect.DRIVER,
        "overrun": False,
        "failed": False,
    }
    assert {name: tick[name].item() for name in FIELDS} == expected


def test_latency_in_lockstep_adds_bench_time_and_computing_time() -> None:
    made = made_pass()
    bench = replace(made, tick=replace(made.tick, now_ns=6_000))
    latency_ns = record(bench, insight(wheel_stamp_ns=4_000))[list(FIELDS).index("latency_ns")]
    assert latency_ns == 2_000 + 80_000


def test_a_tick_that_ends_on_its_deadline_is_no_overrun() -> None:
    assert not made_pass(sent_us=PERIOD_NS // 1000).overrun
    assert made_pass(sent_us=PERIOD_NS // 1000 + 1).overrun


def test_there_is_no_latency_before_the_first_wheel_speeds() -> None:
    assert numbered(0)[list(FIELDS).index("latency_ns")] == NO_LATENCY


def test_a_recording_that_is_not_full_is_read_whole(path: Path) -> None:
    write(path, ticks=5, capacity=8)
    assert read(path)["number"].tolist() == [0, 1, 2, 3, 4]


def test_a_full_ring_keeps_the_newest_ticks_oldest_first(path: Path) -> None:
    write(path, ticks=21, capacity=8)
    # The slot of the oldest is where the next record goes: it is never trusted.
    assert read(path)["number"].tolist() == [14, 15, 16, 17, 18, 19, 20]


def test_a_new_recording_is_empty(path: Path) -> None:
    write(path, ticks=0, capacity=8)
    assert len(read(path)) == 0


def test_a_recording_is_read_while_it_is_written(path: Path) -> None:
    with FlightRecorder(path, RUN, 8) as recorder:
        for number in range(12):
            recorder.write(numbered(number))
            assert read(path)["number"][-1] == number


def test_a_reader_that_comes_back_gets_what_is_new(path: Path) -> None:
    with FlightRecorder(path, RUN, 8) as recorder:
        for number in range(3):
            recorder.write(numbered(number))
        _, bookmark = read_on(path, None)
        assert bookmark == (RUN, 3)
        for number in range(3, 5):
            recorder.write(numbered(number))
        news, bookmark = read_on(path, bookmark)
        assert news["number"].tolist() == [3, 4]
        news, bookmark = read_on(path, bookmark)
        assert (len(news), bookmark.made) == (0, 5)


def test_a_reader_that_was_away_too_long_misses_what_the_ring_dropped(path: Path) -> None:
    with FlightRecorder(path, RUN, 8) as recorder:
        recorder.write(numbered(0))
        _, bookmark = read_on(path, None)
        for number in range(1, 30):
            recorder.write(numbered(number))
        news, bookmark = read_on(path, bookmark)
    assert news["number"].tolist() == [23, 24, 25, 26, 27, 28, 29]
    assert bookmark.made == 30


def test_another_run_is_read_from_its_start(path: Path) -> None:
    write(path, ticks=5, capacity=8)
    _, bookmark = read_on(path, None)
    with FlightRecorder(path, replace(RUN, started_monotonic_ns=99), 8) as recorder:
        recorder.write(numbered(0))
    news, bookmark = read_on(path, bookmark)
    assert (len(news), bookmark.made, bookmark.run.started_monotonic_ns) == (1, 1, 99)


def test_the_header_says_which_run_it_was(path: Path) -> None:
    write(path, ticks=0, capacity=1)
    assert read_info(path) == RUN


def test_the_size_on_disk_never_changes(path: Path) -> None:
    with FlightRecorder(path, RUN, 8) as recorder:
        size = path.stat().st_size
        assert path.stat().st_blocks * 512 >= size
        for number in range(20):
            recorder.write(numbered(number))
        assert path.stat().st_size == size


def test_a_restarted_service_keeps_the_recording_of_the_one_before(path: Path) -> None:
    write(path, ticks=3, capacity=8)
    write(path, ticks=1, capacity=8)
    assert len(read(path)) == 1
    assert len(read(path.with_name("flight.rec.previous"))) == 3


WRITER = """
import sys
from pathlib import Path
sys.path[:0] = sys.argv[2:]
from runtime.fakes import RUN, numbered
from tcs_hil.runtime.recorder import FlightRecorder
recorder = FlightRecorder(Path(sys.argv[1]), RUN, 64)
number = 0
while True:
    recorder.write(numbered(number))
    number += 1
    if number == 1000:
        print("a thousand", flush=True)
"""


def test_a_killed_writer_leaves_every_tick_whole(path: Path) -> None:
    with subprocess.Popen(
        [sys.executable, "-c", WRITER, str(path), *sys.path], stdout=subprocess.PIPE
    ) as writer:
        assert writer.stdout is not None
        assert writer.stdout.readline() == b"a thousand\n"
        writer.kill()
    assert writer.returncode == -signal.SIGKILL
    ticks = read(path)
    numbers = ticks["number"]
    assert len(numbers) == 63
    assert np.all(np.diff(numbers) == 1)
    assert numbers[-1] >= 999
    assert np.all(ticks["limit_fl_nm"] == 61.0)


def test_a_full_disk_is_one_sentence_that_names_the_file(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "posix_fallocate", full)
    with pytest.raises(RecordingError, match=r"flight\.rec: .*No space left on device"):
        FlightRecorder(path, RUN, 8)
    assert not path.exists()


def test_a_folder_that_does_not_exist_is_named(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=r"nowhere.*No such file"):
        FlightRecorder(tmp_path / "nowhere" / "flight.rec", RUN, 8)


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"", "not a flight recording"),
        (b"x" * 10, "not a flight recording"),
        (b"x" * 10_000, "not a flight recording"),
        (PREAMBLE.pack(b"TCSFLREC", 99, 2, 4096, 1) + bytes(100), "layout version 99"),
        (PREAMBLE.pack(b"TCSFLREC", 1, 2, 4096, 1) + bytes(100), "header is damaged"),
    ],
)
def test_a_file_that_is_no_recording_is_refused(path: Path, content: bytes, sentence: str) -> None:
    path.write_bytes(content)
    with pytest.raises(RecordingError, match=rf"flight\.rec: .*{sentence}"):
        read(path)


def test_a_recording_cut_short_is_refused(path: Path) -> None:
    write(path, ticks=3, capacity=8)
    os.truncate(path, path.stat().st_size - PACKER.size)
    with pytest.raises(RecordingError, match="cut short"):
        read(path)


def test_a_missing_recording_is_named(path: Path) -> None:
    with pytest.raises(RecordingError, match=r"flight\.rec: cannot be read"):
        read(path)


def test_a_recording_of_an_older_program_is_read_by_its_own_fields(path: Path) -> None:
    write(path, ticks=2, capacity=4)
    content = path.read_bytes()
    path.write_bytes(content.replace(b'"skipped"', b'"skipper"'))
    assert "skipper" in (read(path).dtype.names or ())
