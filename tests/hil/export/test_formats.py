"""Round trips: what is written is read by the programs of others."""

import json
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import can
import numpy as np
import pandas as pd
import pytest
from asammdf import MDF
from hil.logs.made_run import PERIOD_NS, TICKS, wheel_speed_radps
from needs import needs
from pyarrow import parquet

from tcs_hil.errors import ConfigError
from tcs_hil.hil.export.formats import MODULES, writer_of
from tcs_hil.hil.export.table import Run

GRID_S = np.arange(TICKS) * PERIOD_NS * 1e-9


def written(run: Run, path: Path) -> Path:
    writer_of(path)(path, run)
    return path


def test_mf4_has_a_group_for_each_source_on_one_time_base(run: Run, tmp_path: Path) -> None:
    with MDF(written(run, tmp_path / "run.mf4")) as mdf:
        names = [group.channel_group.acq_name for group in mdf.groups]
        assert names == [*(table.name for table in run.tables), "CAN"]
        for name in ("WheelSpeedsFront.WheelSpeedFL", "telemetry.limit_fl_nm", "truth.limit_fl_nm"):
            np.testing.assert_allclose(mdf.get(name).timestamps, GRID_S, rtol=1e-12)


def test_mf4_holds_the_bus_as_python_can_reads_it(run: Run, tmp_path: Path) -> None:
    with can.LogReader(written(run, tmp_path / "run.mf4")) as reader:
        read = list(reader)
    assert [(each.arbitration_id, bytes(each.data)) for each in read] == [
        (each.arbitration_id, bytes(each.data)) for each in run.frames
    ]
    assert read[-1].timestamp - read[0].timestamp == pytest.approx(GRID_S[-1], abs=2e-6)


def test_mf4_gives_values_units_comments_and_labels(run: Run, tmp_path: Path) -> None:
    with MDF(written(run, tmp_path / "run.mf4")) as mdf:
        speed, state = (
            mdf.get(name) for name in ("WheelSpeedsFront.WheelSpeedFL", "TorqueLimit.TcsState")
        )
        assert mdf.groups[0].channel_group.comment.startswith("Torque ceilings")
        raw_state = mdf.get("TorqueLimit.TcsState", raw=True)
    np.testing.assert_allclose(speed.samples, [wheel_speed_radps(n) for n in range(TICKS)], 1e-9)
    assert speed.unit == "rad/s"
    assert "front left wheel" in speed.comment
    assert set(state.samples) == {b"ACTIVE"}
    assert set(raw_state.samples) == {3}


def test_mf4_knows_when_the_run_was_and_what(run: Run, tmp_path: Path) -> None:
    with MDF(written(run, tmp_path / "run.mf4")) as mdf:
        assert mdf.header.start_time == run.start
        properties = mdf.header._common_properties
    assert properties["controller"] == "pi"
    assert properties["scenario"] == '{"mu": "<0.3 & wet>"}'


def test_a_value_without_a_label_reads_as_the_number_it_is(run: Run, tmp_path: Path) -> None:
    (table, *_) = run.tables
    strange = tuple(
        each._replace(values=np.full(TICKS, 6)) if each.name == "TcsState" else each
        for each in table.channels
    )
    path = written(replace(run, tables=(replace(table, channels=strange),)), tmp_path / "run.mf4")
    with MDF(path) as mdf:
        assert {float(sample) for sample in mdf.get("TorqueLimit.TcsState").samples} == {6.0}


def test_parquet_is_one_table_with_a_row_per_tick_in_lockstep(run: Run, tmp_path: Path) -> None:
    frame = pd.read_parquet(written(run, tmp_path / "run.parquet"))
    np.testing.assert_allclose(frame["time_s"], GRID_S, rtol=1e-12)
    np.testing.assert_array_equal(
        frame["truth.wheel_speed_fl_radps"], [wheel_speed_radps(tick) for tick in range(TICKS)]
    )
    assert frame["DriverRequest.DriverTorqueRequestR"].count() == TICKS // 5


def test_parquet_says_unit_comment_labels_and_start(run: Run, tmp_path: Path) -> None:
    schema = parquet.read_schema(written(run, tmp_path / "run.parquet"))
    about = schema.field("TorqueLimit.TcsState").metadata
    assert json.loads(about[b"labels"])["3"] == "ACTIVE"
    assert schema.field("TorqueLimit.TorqueLimitL").metadata[b"unit"] == b"Nm"
    assert b"air-gap torque" in schema.field("MotorState.MotorTorqueL").metadata[b"comment"].lower()
    assert schema.metadata[b"start_ns"] == str(run.start_ns).encode()
    assert schema.metadata[b"start"] == run.start.isoformat().encode()


def test_nothing_is_lost_where_every_source_has_instants_of_its_own(
    loose_run: Run, tmp_path: Path
) -> None:
    table = parquet.read_table(written(loose_run, tmp_path / "run.parquet"))
    for source in loose_run.tables:
        for channel in source.channels:
            column = table.column(f"{source.name}.{channel.name}")
            kept = column.drop_null().to_numpy()
            np.testing.assert_array_equal(kept, channel.values)
            assert kept.dtype == channel.values.dtype


def test_two_frames_of_one_message_at_one_instant_take_two_rows(run: Run, tmp_path: Path) -> None:
    (table, *_) = run.tables
    twice = replace(table, time_ns=table.time_ns // (2 * PERIOD_NS) * (2 * PERIOD_NS))
    frame = pd.read_parquet(written(replace(run, tables=(twice,)), tmp_path / "run.parquet"))
    assert len(frame) == TICKS
    assert frame["time_s"].nunique() == TICKS // 2


def test_csv_reads_as_the_parquet_file_does(loose_run: Run, tmp_path: Path) -> None:
    read = pd.read_csv(written(loose_run, tmp_path / "run.csv"), comment="#")
    frame = pd.read_parquet(written(loose_run, tmp_path / "run.parquet"))
    assert "TorqueLimit.TorqueLimitL [Nm]" in read
    assert "telemetry.limit_fl_nm [Nm]" in read
    assert "TorqueLimit.TcsState" in read
    np.testing.assert_array_equal(read.to_numpy(), frame.to_numpy())


def test_csv_begins_with_when_the_run_was_and_what(run: Run, tmp_path: Path) -> None:
    lines = written(run, tmp_path / "run.csv").read_text().splitlines()
    assert lines[0] == f"# start: {run.start.isoformat()}"
    assert "# controller: pi" in lines
    assert lines[sum(line.startswith("#") for line in lines)].startswith('"time_s",')


def test_a_candump_log_holds_the_frames_of_the_recording(
    lockstep: Path, run: Run, tmp_path: Path
) -> None:
    with can.LogReader(written(run, tmp_path / "run.log")) as reader:
        read = list(reader)
    with can.LogReader(lockstep / "bus.blf") as reader:
        original = list(reader)
    assert [(frame.arbitration_id, bytes(frame.data)) for frame in read] == [
        (frame.arbitration_id, bytes(frame.data)) for frame in original
    ]
    assert read[0].timestamp == pytest.approx(run.start_ns * 1e-9, abs=1e-6)
    assert read[-1].timestamp - read[0].timestamp == pytest.approx(GRID_S[-1], abs=2e-6)


def test_log2asc_reads_the_candump_log(run: Run, tmp_path: Path) -> None:
    needs(shutil.which("log2asc"), "log2asc (apt-get install can-utils)")
    path = written(run, tmp_path / "run.log")
    text = subprocess.run(
        ["log2asc", "-I", str(path), "can0"], capture_output=True, text=True, check=True
    ).stdout
    rows = [line.split() for line in text.splitlines() if " d " in line]
    assert len(rows) == len(run.frames)
    assert [int(row[2], 16) for row in rows] == [frame.arbitration_id for frame in run.frames]


@pytest.mark.parametrize("suffix", MODULES)
def test_an_export_replaces_what_was_there(run: Run, tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"run{suffix}"
    path.write_bytes(b"x" * 10_000_000)
    assert written(run, path).stat().st_size < 1_000_000


@pytest.mark.parametrize(
    ("name", "complaint"),
    [("run.mdf3", r"run\.mdf3: the suffix must be one of"), ("no/run.mf4", "no such folder")],
)
def test_a_file_nothing_can_write_is_refused(tmp_path: Path, name: str, complaint: str) -> None:
    with pytest.raises(ConfigError, match=complaint):
        writer_of(tmp_path / name)


def test_a_missing_library_is_named_with_the_way_to_get_it(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setitem(MODULES, ".mf4", "no_such_module")
    with pytest.raises(ConfigError, match=r"no_such_module, which comes with pip install"):
        writer_of(tmp_path / "run.mf4")
