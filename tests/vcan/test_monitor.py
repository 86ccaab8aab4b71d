"""The monitor on a real vcan0, at the wheel of an emulator."""

from pathlib import Path

from hil.monitor.by_hand import car_and_service, drive, read_truth

from .conftest import CHANNEL


def test_keys_drive_the_car_over_a_real_bus(tmp_path: Path) -> None:
    with car_and_service(tmp_path, CHANNEL, "lockstep", "--allow-control") as recording:
        drive(
            CHANNEL,
            [
                ([], lambda s: s.source == "socketcan vcan0" and s.state == "STANDBY"),
                (["up", "up", "left"], lambda s: s.left.request_nm == 20.0),
                (["space"], lambda s: s.left.request_nm == 0.0),
            ],
        )
    assert read_truth(recording)["mu"].min() == 0.3
