import time
import uuid
from collections.abc import Iterator
from pathlib import Path

import can
import pytest

from tcs_hil.canbus.bus import open_bus
from tcs_hil.errors import ConfigError
from tcs_hil.hil.record import record

FRAMES = [can.Message(arbitration_id=0x123, data=[i], is_extended_id=False) for i in range(100)]


@pytest.fixture
def buses() -> Iterator[tuple[can.BusABC, can.BusABC]]:
    # The digits at the end are more than a channel number of a BLF file can hold.
    channel = f"vcan-{uuid.uuid4().hex[:8]}-987654321"
    with open_bus("embedded", channel)[0] as listener, open_bus("embedded", channel)[0] as talker:
        yield listener, talker


@pytest.mark.parametrize("suffix", [".blf", ".asc", ".log"])
def test_what_was_sent_before_the_stop_is_recorded_with_calendar_times(
    buses: tuple[can.BusABC, can.BusABC], tmp_path: Path, suffix: str
) -> None:
    listener, talker = buses
    path = tmp_path / f"drive{suffix}"
    before_s = time.time()
    count = record(
        listener, path, stop=lambda: True, ready=lambda: [talker.send(frame) for frame in FRAMES]
    )
    assert count == len(FRAMES)
    options = {"relative_timestamp": False} if suffix == ".asc" else {}
    with can.LogReader(str(path), **options) as reader:
        messages = list(reader)
    assert [m.data for m in messages] == [m.data for m in FRAMES]
    assert messages[0].timestamp == pytest.approx(before_s, abs=60.0)


def test_a_busy_bus_cannot_keep_the_recorder_from_stopping(
    buses: tuple[can.BusABC, can.BusABC], tmp_path: Path
) -> None:
    listener, talker = buses

    receive = listener.recv

    def recv(timeout: float | None = None) -> can.Message | None:
        talker.send(FRAMES[0])
        return receive(timeout)

    listener.recv = recv  # type: ignore[method-assign]
    assert record(listener, tmp_path / "drive.log", lambda: True, lambda: None) <= 1


def test_a_suffix_nobody_knows_is_refused(
    buses: tuple[can.BusABC, can.BusABC], tmp_path: Path
) -> None:
    with pytest.raises(ConfigError, match=r"drive\.mp3"):
        record(buses[0], tmp_path / "drive.mp3", lambda: True, lambda: None)
