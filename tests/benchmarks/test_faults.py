"""The fault campaign's page says where it was driven, and hides nothing."""

import msgspec
import pytest

from benchmarks.faults import page, place
from tcs_hil.hil.faults.suite import family_cells
from tcs_hil.hil.judging.verdict import Verdict
from tcs_hil.hil.run import Mode
from tcs_hil.hil.suite.result import Result

CELL = family_cells()[0]
PASSED = Result(
    name=f"{CELL.name}/manoeuvre-1/pi",
    suite="faults",
    description="",
    controller="pi",
    preset="default",
    mode="lockstep",
    verdict=Verdict.PASSED,
    findings=[],
    figures={},
    wall_s=1.0,
)
BLOCKED = msgspec.structs.replace(PASSED, verdict=Verdict.BLOCKED, error="no answer to tick 7")


@pytest.mark.parametrize(
    ("mode", "channel", "said"),
    [
        ("lockstep", None, "in lockstep over two processes on the embedded bus"),
        ("lockstep", "vcan0", "in lockstep over two processes on SocketCAN's vcan0"),
        ("real-time", "vcan0", "in real time over two processes on SocketCAN's vcan0"),
        ("in-process", None, "in one process"),
    ],
)
def test_the_page_names_pace_and_bus(mode: Mode, channel: str | None, said: str) -> None:
    where = place(mode, channel)
    assert where == said
    assert said in page([CELL], [PASSED], where)[0]


def test_what_did_not_pass_stands_above_the_table_with_its_reason() -> None:
    lines = page([CELL], [PASSED, BLOCKED], "")
    assert lines[1:3] == ["", f"- `{BLOCKED.name}` blocked: no answer to tick 7"]
    assert page([CELL], [PASSED], "")[1:3] == ["", "| fault | owed | named | pi | passed |"]
