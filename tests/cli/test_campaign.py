import json
import os
import re
import signal
import subprocess
import sys
from functools import partial

import pyarrow.parquet as pq
import pytest

STUDY = """
scenario = "short.toml"
points = 6
service = { controller = "off" }
[[vary]]
key = "vehicle.body.mass_kg"
low = 1120.0
high = 1680.0
[[vary]]
key = "road.0.mu"
low = 0.1
high = 0.6
"""
SCENARIO = """
description = "short"
duration_s = 0.2
start_speed_kmph = 30.0
[driver]
request = [[0.0, 200.0]]
"""


def _known(rows):
    """Not a number equals nothing, itself included; JSON has null for it."""
    return [{k: v for k, v in row.items() if str(v) not in ("None", "nan")} for row in rows]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    (tmp_path / "study.toml").write_text(STUDY)
    (tmp_path / "short.toml").write_text(SCENARIO + "[[road]]\nmu = 0.3\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def campaign(tcs_hil, folder):
    return partial(tcs_hil, "campaign", "study.toml")


def test_a_campaign_goes_on_where_it_was_and_tells_how_to_drive_one_again(campaign, folder):
    assert campaign("--points", "6", "--out", "out", "-j", "1").status == 0
    table = folder / "out" / "campaign.parquet"
    first = pq.read_table(table).to_pylist()
    assert [row["index"] for row in first] == list(range(6))
    assert (folder / "out" / "campaign.png").read_bytes().startswith(b"\x89PNG")

    # As after an interruption: some rows in a part, no table yet.
    pq.write_table(pq.read_table(table).slice(0, 4), table.with_name("part-0000000.parquet"))
    table.unlink()
    ended = campaign("--points", "6", "--out", "out", "-j", "1")
    assert ended.status == 0, ended.err
    assert _known(pq.read_table(table).to_pylist()) == _known(first)

    again = ended.out.split("Drive one again: tcs-hil campaign study.toml ")[1].splitlines()[0]
    assert "--out out" in again
    row = json.loads(campaign(*again.split(), "--json").out)
    assert _known([row]) == _known([first[row["index"]]])
    for kept in ("toml", "service.toml"):
        assert (folder / "out" / f"point-{row['index']}.{kept}").is_file()


def test_an_interrupted_campaign_says_how_to_go_on(folder):
    arguments = ("campaign", "study.toml", "--points", "4000", "--out", "out", "-j", "1")
    with subprocess.Popen(
        [sys.executable, "-m", "tcs_hil", *arguments],
        stderr=subprocess.PIPE,
        text=True,
        cwd=folder,
        start_new_session=True,
    ) as child:
        assert "short" in child.stderr.readline()  # progress: the first batch is kept
        os.killpg(child.pid, signal.SIGINT)  # as a terminal does
        error = child.stderr.read()
        assert child.wait() == 130
    told = re.search(r"interrupted; (\d+) of 4000 points are kept, go on with: (.+)\n", error)
    assert int(told[1]) >= 4
    assert told[2].split()[-len(arguments) :] == list(arguments)
    assert "Traceback" not in error


@pytest.mark.parametrize(
    ("broken", "arguments", "named"),
    [
        ("road.9.mu", [], "`road.9.mu`"),
        ("road.0.mu", ["--only", "6"], "--only 6"),
        ("colour", [], "`colour`"),
        ("sensors.pitch_error_ratio", [], "pitch_error_ratio"),  # 0.6 is beyond its bounds
    ],
)
def test_a_bad_study_is_refused_in_one_sentence(broken, arguments, named, campaign, folder):
    (folder / "study.toml").write_text(STUDY.replace("road.0.mu", broken))
    assert campaign(*arguments).is_one_sentence_about(named)
