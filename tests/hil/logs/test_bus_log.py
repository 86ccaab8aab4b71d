"""Bus logs in the formats of others."""

import gc
from pathlib import Path

import can
import pytest

from tcs_hil.errors import ConfigError
from tcs_hil.hil.logs.bus_log import read_log, stamp_ns

START_S = 1_790_000_000.25
FRAMES = [
    can.Message(timestamp=START_S + 0.002 * n, arbitration_id=0x123, data=[n], is_extended_id=False)
    for n in range(20)
]


@pytest.mark.parametrize("suffix", [".blf", ".asc", ".log", ".mf4"])
def test_every_format_gives_frames_and_calendar_times(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"drive{suffix}"
    with can.Logger(str(path)) as write:
        for frame in FRAMES:
            write(frame)
        write(can.Message(timestamp=START_S + 1.0, is_error_frame=True))
    frames = list(read_log(path))
    assert [bytes(frame.data) for frame in frames] == [bytes(frame.data) for frame in FRAMES]
    for frame, original in zip(frames, FRAMES, strict=True):
        assert stamp_ns(frame) == pytest.approx(1e9 * original.timestamp, abs=1_000)


def test_a_remote_frame_carries_no_signals(tmp_path: Path) -> None:
    path = tmp_path / "drive.log"
    with can.Logger(str(path)) as write:
        write(can.Message(timestamp=START_S, arbitration_id=0x123, is_remote_frame=True))
    assert not list(read_log(path))


@pytest.mark.parametrize(
    ("name", "content", "complaint"),
    [
        ("none.blf", None, "cannot be read"),
        ("bad.xyz", b"whatever", "no recording python-can can read"),
        ("bad.blf", b"whatever, and more of it" * 10, "no recording python-can can read"),
    ],
)
def test_what_is_no_log_is_refused_by_name(
    tmp_path: Path, name: str, content: bytes | None, complaint: str
) -> None:
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(ConfigError, match=complaint) as refusal:
        list(read_log(path))
    assert name in str(refusal.value)


@pytest.mark.filterwarnings("ignore:unclosed file:ResourceWarning")
def test_a_damaged_mf4_is_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "bad.mf4"
    path.write_bytes(b"whatever, and more of it" * 10)
    with pytest.raises(ConfigError, match=r"bad\.mf4: no recording python-can can read"):
        list(read_log(path))
    gc.collect()  # asammdf leaves the file open, which must not count against a later test
