"""Emulator, service and monitor as they are used: processes on a bus, keys in a terminal."""

import json
import uuid
from pathlib import Path

import numpy as np
import pytest
from hil.monitor.by_hand import car_and_service, drive, read_truth


@pytest.fixture
def channel() -> str:
    return f"vcan-{uuid.uuid4().hex[:8]}"


def test_a_person_drives_onto_ice_and_gives_the_car_back(tmp_path: Path, channel: str) -> None:
    with car_and_service(tmp_path, channel, "realtime", "--allow-control") as recording:
        drive(
            channel,
            [
                ([], lambda s: s.state == "STANDBY"),
                (["up"] * 20, lambda s: s.left.request_nm == 200.0),
                # On the dry road 200 Nm slip by some 0.04: more than twice that is ice.
                (["left"], lambda s: s.state == "ACTIVE" and s.left.slip_ratio > 0.09),
                (["space"], lambda s: s.left.request_nm == 0.0),
            ],
        )
    truth = read_truth(recording)
    mu, slip = truth["mu"][:, 0], truth["slip_ratio"][:, 0]
    assert set(np.unique(mu)) == {0.3, 1.0}
    assert slip[mu < 0.5].max() > 0.09


def test_a_person_drives_in_lockstep_too(tmp_path: Path, channel: str) -> None:
    with car_and_service(tmp_path, channel, "lockstep", "--allow-control"):
        drive(
            channel,
            [
                ([], lambda s: s.state == "STANDBY"),
                (["up", "up"], lambda s: s.left.request_nm == 20.0),
                (["2"], lambda s: s.fault_code != 0),
                (["space"], lambda s: s.left.request_nm == 0.0 and s.fault_code == 0),
            ],
        )


def test_a_car_that_nobody_may_drive_counts_who_tried(tmp_path: Path, channel: str) -> None:
    with car_and_service(tmp_path, channel, "realtime") as recording:
        drive(channel, [(["up"] * 5, lambda s: s.state == "STANDBY")])
    assert "control frames ignored, see --allow-control" in (tmp_path / "car.log").read_text()
    assert not read_truth(recording)["request_nm"].any()


def test_one_look_at_a_bus_is_printed_as_json(tmp_path: Path, channel: str) -> None:
    from click.testing import CliRunner

    from tcs_hil.cli.monitor import command

    with car_and_service(tmp_path, channel, "realtime"):
        result = CliRunner().invoke(command, ["--channel", channel, "--json"])
    snapshot = json.loads(result.stdout)
    assert snapshot["source"] == f"embedded {channel}"
    assert snapshot["rates_hz"]["TorqueLimit"] > 0
