"""Bus logs in the formats of others."""

import gc
from pathlib import Path

import can
import pytest

from tcs_hil.errors import ConfigError
from tcs_hil.hil.logs.bus_log import BrokenOffError, read_log, salvage_log, stamp_ns

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


@pytest.fixture
def containers(tmp_path: Path) -> Path:
    """A BLF file of several containers, so that a cut leaves some of them whole."""
    path = tmp_path / "drive.blf"
    with can.Logger(str(path), max_container_size=200) as write:
        for frame in FRAMES:
            write(frame)
    return path


def test_a_whole_log_has_lost_nothing(containers: Path) -> None:
    frames, lost = salvage_log(containers)
    assert (len(frames), lost) == (len(FRAMES), "")


@pytest.mark.parametrize("left", [0.5, 0.95])
def test_of_a_log_that_is_cut_short_the_frames_before_are_saved(
    containers: Path, left: float
) -> None:
    content = containers.read_bytes()
    containers.write_bytes(content[: int(left * len(content))])
    frames, lost = salvage_log(containers)
    assert 0 < len(frames) < len(FRAMES)
    read = f"{containers}: is cut short: {len(frames)} frames were read of the 20 records"
    assert lost.startswith(read)


def test_a_recorder_that_was_killed_has_lost_what_it_still_held(containers: Path) -> None:
    with can.BLFWriter(containers, max_container_size=200) as write:
        for frame in FRAMES:
            write(frame)
        write.file.flush()
        as_left = containers.read_bytes()
    containers.write_bytes(as_left)
    frames, lost = salvage_log(containers)
    assert 0 < len(frames) < len(FRAMES)
    assert f"drive.blf: was never closed: {len(frames)} frames were read" in lost


def test_damage_inside_a_log_ends_it_there(containers: Path) -> None:
    content = bytearray(containers.read_bytes())
    place = content.rindex(b"LOBJ")
    containers.write_bytes(content[:place] + b"JBOL" + content[place + 4 :])
    frames, lost = salvage_log(containers)
    assert 0 < len(frames) < len(FRAMES)
    assert f"drive.blf: breaks off after {len(frames)} frames" in lost


def test_who_needs_a_whole_log_is_refused_at_its_end(containers: Path) -> None:
    content = containers.read_bytes()
    containers.write_bytes(content[: len(content) // 2])
    frames = read_log(containers)
    assert next(frames).arbitration_id == 0x123
    with pytest.raises(BrokenOffError, match="is cut short"):
        list(frames)


def test_a_log_cut_before_its_first_frame_is_refused(containers: Path) -> None:
    containers.write_bytes(containers.read_bytes()[:150])
    with pytest.raises(ConfigError, match=r"drive\.blf: "):
        salvage_log(containers)


@pytest.mark.filterwarnings("ignore:unclosed file:ResourceWarning")
def test_a_damaged_mf4_is_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "bad.mf4"
    path.write_bytes(b"whatever, and more of it" * 10)
    with pytest.raises(ConfigError, match=r"bad\.mf4: no recording python-can can read"):
        list(read_log(path))
    gc.collect()  # asammdf leaves the file open, which must not count against a later test
