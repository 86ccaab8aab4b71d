"""The service on another car's DBC, on a real vcan0."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tcs_hil.canbus.bus import open_bus
from tcs_hil.hil.processes.program import program
from tcs_hil.runtime.recording import read
from tcs_hil.signals import TcsState
from tests.canbus.mapping.bridge import drive
from tests.canbus.mapping.makers import MAKERS, MONTANE, Maker

from .conftest import CHANNEL, Candump, Interface


@pytest.mark.parametrize("maker", MAKERS, ids=lambda maker: maker.name)
def test_a_launch_in_lockstep_on_every_makers_bus(
    maker: Maker, tmp_path: Path, vcan0: Interface
) -> None:
    ours = f"vcan-ours-{os.getpid()}"
    emulators, _ = open_bus("embedded", ours)
    services, description = open_bus("auto", CHANNEL)
    assert description == f"socketcan {CHANNEL}"
    with emulators, services:
        ticks, _, flight = drive(maker, emulators, services, tmp_path, (ours, CHANNEL))
    recorded = read(flight)
    assert ticks == len(recorded) == 200
    assert set(np.unique(recorded["state"])) == {
        TcsState.INIT,
        TcsState.STANDBY,
        TcsState.ACTIVE,
    }
    refused = ("e2e_errors", "e2e_repeated", "e2e_wrong_sequence", "lost_frames", "bus_errors")
    assert not any(recorded[name].any() for name in refused)


def test_candump_sees_the_makers_identifier_and_no_other(
    tmp_path: Path, candump: Callable[[int], Candump]
) -> None:
    dump = candump(50)
    config = str(MONTANE.toml)
    with program("tcs_hil", "run", "--config", config, log=tmp_path / "service.log"):
        seen = dump.frames()
    # Alone on its bus it limits nothing: raw 4095 twice, mode 2, neither motor active.
    assert {frame[:12] for frame in seen} == {"160#0FFF2FFF"}
    payloads = [bytes.fromhex(frame.partition("#")[2]) for frame in seen]
    assert all(data[5] == sum(data[:5]) & 0xFF for data in payloads)
    assert [data[4] for data in payloads] == [count % 16 for count in range(1, 51)]
