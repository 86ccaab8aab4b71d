"""The result as Markdown."""

from __future__ import annotations

from tcs_hil.hil.bench.bus import BusRow
from tcs_hil.hil.bench.controllers import ControllerRow
from tcs_hil.hil.bench.page import page
from tcs_hil.hil.bench.result import Result
from tcs_hil.hil.bench.scaling import ScalingRow
from tcs_hil.hil.bench.start import StartRow
from tcs_hil.hil.bench.statistics import Cost, Statistics
from tcs_hil.hil.bench.tick import STAGES, TickCost, TickRow
from tcs_hil.hil.paper import SolveTime

TIMES = Statistics(10, 1.25, 1.0, 12.0, 13.4, 14.0)
COST = Cost(TIMES, TIMES)


def line(result: Result, needle: str) -> str:
    return next(each for each in page(result) if needle in each)


def test_a_peer_that_is_not_installed_has_a_line_that_says_so() -> None:
    absent = ControllerRow("NMPC", "paper", "do-mpc", "m", None, None, SolveTime(197.0, 600.0))
    shown = line(Result("here", controllers=[absent]), "do-mpc")
    assert "not installed" in shown
    assert "197 / 600" in shown


def test_a_law_stands_beside_the_paper_with_its_deviation() -> None:
    row = ControllerRow("KMPC", "paper", "native", "m", COST, 2e-13, SolveTime(4.0, 43.2))
    shown = line(Result("here", controllers=[row]), "native")
    assert shown.split(" | ")[4:] == (
        ["10", "1.25", "1.00", "12", "14", "1.00", "12", "4 / 43.2", "2e-13 |"]
    )


def test_every_line_of_a_table_has_as_many_cells_as_its_heading() -> None:
    tick = TickRow("KMPC", "paper", "native", TickCost(COST, dict.fromkeys(STAGES, TIMES)), 9)
    bus = BusRow("KMPC", "embedded", ["memory locked"], 9, 0, 0, 0, TIMES, TIMES, TIMES, TIMES)
    scaling = [ScalingRow("KMPC", "native", "order", order, COST) for order in (2, 4)]
    start = StartRow("KMPC", "default", "native", [0.3, 0.5, 0.4])
    controller = ControllerRow("KMPC", "paper", "native", "m", COST, None, None)
    result = Result("here", [controller], [tick], scaling, [bus], [start])
    widths = None
    for each in page(result):
        if not each.startswith("|"):
            widths = None
            continue
        widths = widths or each.count("|")
        assert each.count("|") == widths
    assert "without memory locked" in line(result, "On a bus")
    assert "2: 1.00  4: 1.00" in line(result, "order |")
    assert "| 0.40 | 0.50 |" in line(result, "| 0.40")
