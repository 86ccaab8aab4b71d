"""Recorded drives: the service's own bus log or a CSV, as runs for identification."""

from __future__ import annotations

from pathlib import Path

import can
import numpy as np
import pytest
from factories import command

from tcs_hil.canbus.database import load_database
from tcs_hil.canbus.tcs_node import TcsNode
from tcs_hil.canbus.vehicle_node import VehicleNode, VehicleSignals
from tcs_hil.control.settings import ControlSettings
from tcs_hil.errors import ConfigError
from tcs_hil.hil.drives import CSV_COLUMNS, read_drive
from tcs_hil.model.excitation import Runs
from tcs_hil.model.vehicle import Vehicle

PERIOD_NS, DELAY, TICKS = 2_000_000, 3, 400
SETTINGS, VEHICLE = ControlSettings(), Vehicle()
SPEED_MPS = 20.0 * VEHICLE.wheel_radius_m


def limits_nm() -> np.ndarray:
    """A limit that jumps between two levels, in steps of random length."""
    rng = np.random.default_rng(4)
    levels = np.repeat(np.resize([80.0, 120.0], 100), rng.integers(2, 15, 100))
    return levels[:TICKS]


def motor_torque_nm(limits: np.ndarray) -> np.ndarray:
    """The motor's answer, `DELAY` periods and a lag of 5 ms later."""
    torque = np.full(TICKS, limits[0])
    for tick in range(1, TICKS):
        acting = limits[max(tick - 1 - DELAY, 0)]
        torque[tick] = acting + (torque[tick - 1] - acting) * np.exp(-0.4)
    return torque


def signals(torque_nm: float) -> VehicleSignals:
    return VehicleSignals(
        wheel_speed_radps=(22.0, 22.0, 20.0, 20.0),
        wheel_speed_valid=(True, True, True, True),
        motor_speed_radps=(66.0, 66.0),
        motor_torque_nm=(torque_nm, torque_nm),
        driver_torque_nm=(200.0, 200.0),
        accel_x_mps2=0.0,
    )


@pytest.fixture(scope="module", params=["drive.blf", "drive.mf4"])
def log(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("drives") / request.param
    database = load_database()
    car, service = VehicleNode(database), TcsNode(database)
    limits = limits_nm()
    torque = motor_torque_nm(limits)
    with can.Logger(str(path)) as write:
        for tick in range(TICKS):
            now_ns = tick * PERIOD_NS
            sent = sorted(car.frames(signals(torque[tick]), now_ns))
            limit_nm = float(limits[tick])
            sent += service.frames(command(limit_nm, limit_nm), now_ns)
            for offset, (frame_id, data) in enumerate(sent):
                stamp_s = 1e-9 * now_ns + 1e-5 * offset
                write(
                    can.Message(
                        timestamp=1.7e9 + stamp_s,
                        arbitration_id=frame_id,
                        data=data,
                        is_extended_id=False,
                    )
                )
    return path


def test_a_log_becomes_one_run_per_driven_wheel(log: Path) -> None:
    runs = read_drive(log, SETTINGS, VEHICLE)
    assert runs.speed_mps.shape == runs.sample.wheel_speed_radps.shape
    assert runs.command_nm.shape == (len(runs.speed_mps) - 1, 2)
    assert len(runs.speed_mps) > TICKS - 10
    np.testing.assert_allclose(runs.speed_mps[-50:], SPEED_MPS, rtol=0.02)
    np.testing.assert_allclose(runs.sample.motor_speed_radps[-1], 22.0, rtol=0.01)


def test_each_command_stands_where_it_begins_to_act(log: Path) -> None:
    runs = read_drive(log, SETTINGS, VEHICLE)
    assert mismatch_nm(runs, 0) < 1.0
    assert mismatch_nm(runs, 1) > 5.0
    assert mismatch_nm(runs, -1) > 5.0


def mismatch_nm(runs: Runs, shift: int) -> float:
    """What a motor of 5 ms lag leaves of the recorded torque if commands act ``shift`` later."""
    torque, acting = runs.sample.motor_torque_nm[:, 0], np.roll(runs.command_nm[:, 0], shift)
    expected = acting + (torque[:-1] - acting) * np.exp(-0.4)
    return float(np.abs(expected - torque[1:])[20:-20].max())


def test_what_goes_before_the_motors_are_heard_is_left_out(log: Path, tmp_path: Path) -> None:
    motors = load_database().messages["MotorState"].frame_id
    cut = tmp_path / "cut.blf"
    with can.LogReader(str(log)) as whole, can.Logger(str(cut)) as write:
        for message in whole:
            if message.arbitration_id != motors or message.timestamp > 1.7e9 + 0.1:
                write(message)
    runs = read_drive(cut, SETTINGS, VEHICLE)
    assert len(runs.speed_mps) == pytest.approx(TICKS - 50, abs=10)
    assert np.isfinite(runs.sample.motor_torque_nm).all()


def test_an_exported_csv_is_told_which_columns_it_would_need(tmp_path: Path) -> None:
    path = tmp_path / "export.csv"
    path.write_text('# start: 2026\n"time_s","MotorState.MotorSpeedL [rad/s]"\n0.0,1.0\n')
    with pytest.raises(ConfigError, match="needs two rows and the columns speed_mps, "):
        read_drive(path, SETTINGS, VEHICLE)


def test_a_csv_of_one_wheel_is_read_by_its_header(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    rows = "\n".join(f"{k},{6 + k},{20 + k},{60 + 3 * k},{90 + k},{100 + k}" for k in range(3))
    path.write_text("time_s," + ",".join(CSV_COLUMNS) + "\n" + rows)
    runs = read_drive(path, SETTINGS, VEHICLE)
    np.testing.assert_array_equal(runs.sample.motor_speed_radps[:, 0], [20.0, 21.0, 22.0])
    np.testing.assert_array_equal(runs.command_nm[:, 0], [100.0, 101.0])
    assert runs.sample.slip_speed_mps[0, 0] == pytest.approx(20.0 * 0.318 - 6.0)


@pytest.mark.parametrize(
    ("name", "content", "complaint"),
    [
        ("none.blf", None, "cannot be read"),
        ("none.csv", None, "cannot be read as CSV"),
        ("bad.xyz", "whatever", "no recording python-can can read"),
        ("bad.csv", "speed_mps,wheel_speed_radps\n1,2\n3,4", "needs two rows and the columns"),
        ("text.csv", ",".join(CSV_COLUMNS) + "\na,b,c,d,e", "cannot be read as CSV"),
        ("empty.log", "", "holds no drive of this service's bus"),
    ],
)
def test_what_is_no_drive_is_refused_in_one_sentence(
    name: str, content: str | None, complaint: str, tmp_path: Path
) -> None:
    path = tmp_path / name
    if content is not None:
        path.write_text(content)
    with pytest.raises(ConfigError, match=complaint) as refusal:
        read_drive(path, SETTINGS, VEHICLE)
    assert name in str(refusal.value)
