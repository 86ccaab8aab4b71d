"""`tcs-hil bench --quick` runs; how fast anything is, no test says."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path


def bench(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "tcs_hil", "bench", *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_bus_and_start_leave_their_figures_and_a_section(tmp_path: Path) -> None:
    readme = tmp_path / "README.md"
    arguments = ("--quick", "--only", "bus,start", "--json", "--write", str(readme))
    ended = bench(*arguments)
    assert ended.returncode == 0, ended.stderr
    result = json.loads(ended.stdout)
    (bus,) = result["bus"]
    assert bus["ticks"] > 0
    assert bus["baseline"]["samples"] == 500  # a second
    assert {"p50_us", "p99_us", "p99_9_us", "max_us"} <= bus["jitter"].keys()
    assert all(len(row["seconds"]) == 1 for row in result["start"])
    assert result["controllers"] is None
    page = readme.read_text()
    assert page.startswith("<!-- begin tcs-hil bench -->")
    assert "wake jitter without the service" in page


def test_an_unknown_part_is_refused_with_the_parts_there_are() -> None:
    ended = bench("--only", "warp")
    assert ended.returncode == 2
    assert "controllers, tick, scaling, bus, start" in ended.stderr
