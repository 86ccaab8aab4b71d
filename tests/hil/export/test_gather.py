"""Decoding: what the tables hold of a log, a flight recording and a truth."""

from pathlib import Path

import can
import cantools
import numpy as np
import pytest
from hil.logs.made_run import TICKS, wheel_speed_radps

from tcs_hil.errors import ConfigError
from tcs_hil.hil.export.gather import gather
from tcs_hil.hil.export.table import Channel, Run
from tcs_hil.hil.logs.sources import Sources, find_sources

FOREIGN = """VERSION ""
NS_ :
BS_:
BU_: ECU
BO_ 256 Mixed: 2 ECU
 SG_ Kind M : 0|8@1+ (1,0) [0|255] "" ECU
 SG_ Heat m0 : 8|8@1- (0.5,10) [-54|73.5] "degC" ECU
 SG_ Gear m1 : 8|8@1+ (1,0) [0|255] "" ECU
CM_ SG_ 256 Heat "Of the oil";
VAL_ 256 Gear 0 "P" 1 "R" 2 "N" ;
"""


def channel(run: Run, table: str, name: str) -> Channel:
    found = next(each for each in run.tables if each.name == table)
    return next(each for each in found.channels if each.name == name)


def test_signals_are_decoded_with_unit_and_comment(run: Run) -> None:
    speed = channel(run, "WheelSpeedsFront", "WheelSpeedFL")
    expected = [wheel_speed_radps(tick) for tick in range(TICKS)]
    np.testing.assert_allclose(speed.values, expected, atol=0.005)
    assert speed.unit == "rad/s"
    assert speed.comment.startswith("Angular speed of the front left wheel")


def test_enumerations_carry_their_labels_and_scaled_signals_stay_numbers(run: Run) -> None:
    state, limit = (channel(run, "TorqueLimit", name) for name in ("TcsState", "TorqueLimitR"))
    assert set(state.values) == {3}
    assert state.labels[3] == "ACTIVE"
    assert limit.values == pytest.approx(819.15)  # raw 16383, "no limit"
    assert not limit.labels


def test_counters_and_checksums_are_exported_too(run: Run) -> None:
    counter = channel(run, "TorqueLimit", "TorqueLimitCounter").values
    assert set(np.diff(counter) % 16) == {1}


def test_telemetry_has_units_labels_and_unquantised_values(run: Run) -> None:
    proposal, state = (channel(run, "telemetry", name) for name in ("limit_fl_nm", "state"))
    assert (proposal.unit, proposal.values[0]) == ("Nm", 61.0)
    assert state.labels[int(state.values[0])] == "ACTIVE"


def test_truth_is_flat_with_a_wheel_in_each_name(run: Run) -> None:
    expected = [wheel_speed_radps(tick) for tick in range(TICKS)]
    speed = channel(run, "truth", "wheel_speed_fl_radps")
    np.testing.assert_array_equal(speed.values, expected)
    assert speed.unit == "rad/s"
    assert channel(run, "truth", "mu_rl").values[0] == 0.3
    assert channel(run, "truth", "limit_fr_nm").unit == "Nm"
    assert channel(run, "truth", "slip_ratio_fl").unit == "-"


def test_a_run_says_what_it_was(run: Run) -> None:
    assert run.about["controller"] == "pi"
    assert run.about["scenario"] == '{"mu": "<0.3 & wet>"}'


def test_another_dbc_decodes_another_bus(tmp_path: Path) -> None:
    dbc, log = tmp_path / "foreign.dbc", tmp_path / "drive.log"
    dbc.write_text(FOREIGN)
    with can.Logger(str(log)) as write:
        for data in (b"\x00\x14", b"\x01\x02", b"\x00"):
            write(can.Message(arbitration_id=256, data=data, is_extended_id=False))
        write(can.Message(arbitration_id=256, data=b"\x00\x14", is_extended_id=True))
    run = gather(Sources(bus=log), dbc)
    heat, gear = (channel(run, "Mixed", name) for name in ("Heat", "Gear"))
    np.testing.assert_array_equal(heat.values, [20.0, np.nan])
    np.testing.assert_array_equal(gear.values, [np.nan, 2.0])
    assert (heat.unit, heat.comment, gear.labels[2]) == ("degC", "Of the oil", "N")
    assert len(run.frames) == 4  # what could not be decoded is still in the log


def test_a_log_of_strangers_has_frames_and_no_signals(tmp_path: Path) -> None:
    log = tmp_path / "drive.log"
    log.write_text("(1700000000.000000) can0 7AA#00\n")
    run = gather(Sources(bus=log))
    assert len(run.frames) == 1
    with pytest.raises(ConfigError, match="no frame is of a message in the DBC"):
        _ = run.decoded


def test_a_damaged_truth_is_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "truth.npz"
    path.write_bytes(b"PK\x03\x04 and nothing more")
    with pytest.raises(ConfigError, match=r"truth\.npz: no truth of the plant"):
        gather(find_sources([path]))


def test_decoded_values_are_those_cantools_gives(run: Run, lockstep: Path) -> None:
    dbc = cantools.database.load_file("dbc/tcs.dbc")
    with can.LogReader(lockstep / "bus.blf") as reader:
        raw = [message for message in reader if message.arbitration_id == 0x0A0]
    torque = [dbc.decode_message(0x0A0, message.data)["MotorTorqueL"] for message in raw]
    np.testing.assert_array_equal(channel(run, "MotorState", "MotorTorqueL").values, torque)
