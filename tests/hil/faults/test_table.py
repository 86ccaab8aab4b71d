"""The campaign's results, as the page shows them."""

from __future__ import annotations

from dataclasses import replace

import msgspec

from tcs_hil.fault_codes import FaultCode
from tcs_hil.hil.faults.cell import Cell
from tcs_hil.hil.faults.promises import lost, nothing
from tcs_hil.hil.faults.table import headings, legend, rows, shortfalls, summary
from tcs_hil.hil.judging.verdict import Finding, Verdict
from tcs_hil.hil.suite.result import Result

LOST = Cell("dropped", ("MotorState",), "dropped", lost(0.002, FaultCode.MOTOR_STATE_LATE), 0.1)
UNREAD = Cell("dropped", ("TcsStatus",), "dropped", nothing("no decision rests on it"), 0.1)


def finding(limit: str, measured: float | None, reason: str = "") -> Finding:
    return Finding(limit=limit, verdict=Verdict.PASSED, reason=reason, measured=measured)


def result(
    cell: Cell, manoeuvre: int, named_ms: float | None, rise_nm: float, *, law: str = "pi"
) -> Result:
    findings = [
        finding("limit above request <= 0.025 Nm", 0.0),
        finding("rise beyond its rate <= 0.05 Nm", 0.0),
        finding("largest rise per tick <= 40.05 Nm", rise_nm),
        finding("named", None, "MOTOR_STATE_LATE, MOTOR_STATE_CORRUPT" if named_ms else ""),
        finding("time to detect <= 6 ms", named_ms),
        finding("time to react <= 22 ms", None if named_ms is None else named_ms + 16.0),
        finding("time back <= 68 ms", 36.0 + manoeuvre),
    ]
    return Result(
        name=f"{cell.name}/manoeuvre-{manoeuvre}/{law}",
        suite="faults",
        description="",
        controller=law,
        preset="default",
        mode="in-process",
        verdict=Verdict.PASSED,
        findings=findings,
        figures={},
        wall_s=1.0,
    )


def cells_of(cell: Cell, results: list[Result]) -> dict[str, str]:
    (row,) = rows([cell], results)
    return dict(zip(headings(results), row, strict=True))


def test_a_law_is_shown_by_its_worse_manoeuvre() -> None:
    row = cells_of(LOST, [result(LOST, 1, 4.0, 1.0), result(LOST, 2, 2.0, 7.25)])
    assert row["fault"] == "`MotorState` dropped"
    assert row["owed"] == "FAULT in 22 ms"
    assert row["named"] == "13, 33"
    assert row["pi"] == "4 → 20 · 7.2 · 38"
    assert row["passed"] == "2 of 2"


def test_a_manoeuvre_that_shows_nothing_is_not_hidden_by_the_other() -> None:
    row = cells_of(LOST, [result(LOST, 1, 4.0, 1.0), result(LOST, 2, None, 1.0)])
    assert row["pi"].startswith("4 or - → 20 or - ·")


def test_what_is_owed_at_one_speed_only_says_so() -> None:
    cell = replace(LOST, slow_promise=UNREAD.promise)
    row = cells_of(cell, [result(cell, 1, None, 0.0)])
    assert row["owed"] == "FAULT in 22 ms, at walking pace *a*"
    assert legend([cell]) == legend([UNREAD])


def test_what_is_not_owed_points_to_its_reason() -> None:
    row = cells_of(UNREAD, [result(UNREAD, 1, None, 0.0)])
    assert (row["owed"], row["named"]) == ("*a*", "-")
    assert row["pi"] == "- · 0.0 · 37"
    assert legend([UNREAD]) == ["- *a*: no decision rests on it."]


def test_the_summary_counts_what_did_not_pass() -> None:
    failed = [msgspec.structs.replace(result(LOST, 1, 4.0, 1.0), verdict=Verdict.BLOCKED)]
    failed.append(result(UNREAD, 1, None, 0.0))
    text = summary([LOST, UNREAD], failed, "in lockstep")
    assert text.startswith(
        "2 faults, 1 of which must be found, make 2 runs in lockstep: 1 passed, 1 did not."
    )


def test_what_did_not_pass_is_listed_with_its_reason() -> None:
    good = result(LOST, 1, 4.0, 1.0)
    blocked = msgspec.structs.replace(good, verdict=Verdict.BLOCKED, error="no answer to tick 7")
    assert shortfalls([good]) == []
    assert shortfalls([good, blocked]) == [f"- `{good.name}` blocked: no answer to tick 7"]


def test_only_the_laws_that_were_driven_have_a_column() -> None:
    both = [result(LOST, 1, 4.0, 1.0, law="kmpc"), result(LOST, 1, 4.0, 1.0, law="nmpc")]
    assert headings(both)[3:] == ["kmpc", "nmpc", "passed"]
    (row,) = rows([LOST], both)
    assert row[-1] == "2 of 2"
