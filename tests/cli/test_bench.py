"""`tcs-hil bench --quick` runs; how fast anything is, no test says."""

from __future__ import annotations

import json
from pathlib import Path

from cli.ended import TcsHil


def test_bus_and_start_leave_their_figures_and_a_section(tcs_hil: TcsHil, tmp_path: Path) -> None:
    readme = tmp_path / "README.md"
    ended = tcs_hil("bench", "--quick", "--only", "bus,start", "--json", "--write", str(readme))
    assert ended.status == 0, ended.err
    result = json.loads(ended.out)
    (bus,) = result["bus"]
    assert bus["ticks"] > 0
    assert bus["baseline"]["samples"] == 500  # a second
    assert {"p50_us", "p99_us", "p99_9_us", "max_us"} <= bus["jitter"].keys()
    assert all(len(row["seconds"]) == 1 for row in result["start"])
    assert result["controllers"] is None
    page = readme.read_text()
    assert page.startswith("<!-- begin tcs-hil bench -->")
    assert "wake jitter without the service" in page
