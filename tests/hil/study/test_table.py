import pyarrow.parquet as pq
import pytest

from tcs_hil.errors import ConfigError
from tcs_hil.hil.study.table import Table

ROWS = [{"index": index, "rmse_ratio": 0.1 * index, "error": ""} for index in range(4)]


def test_rows_are_on_disk_before_the_study_ends(plan, tmp_path):
    Table(tmp_path, plan()).add(ROWS[:2])
    assert Table(tmp_path, plan()).done == {0, 1}


def test_the_end_is_one_table_in_the_order_of_the_points(plan, tmp_path):
    table = Table(tmp_path, plan())
    table.add(ROWS[2:])
    table.add(ROWS[:2])
    table.finish()
    assert pq.read_table(table.path).to_pylist() == ROWS
    assert not list(tmp_path.glob("part-*"))
    assert Table(tmp_path, plan()).rows == ROWS


def test_an_interrupted_write_leaves_nothing_that_is_read(plan, tmp_path):
    Table(tmp_path, plan())
    (tmp_path / "part-0000000.draft").write_bytes(b"half a ta")
    assert Table(tmp_path, plan()).rows == []


def test_the_rows_of_another_study_are_not_mixed_in(plan, tmp_path):
    Table(tmp_path, plan(seed=1)).add(ROWS)
    with pytest.raises(ConfigError, match="holds another study"):
        Table(tmp_path, plan(seed=2))


def test_a_folder_that_cannot_be_made_is_refused(plan, tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(ConfigError, match="cannot be written"):
        Table(tmp_path / "file", plan())
