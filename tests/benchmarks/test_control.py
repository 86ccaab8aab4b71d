import math

from benchmarks.control import Row, against_the_yardstick, worse_in
from tcs_hil.hil.metrics import Score, SlipMetrics


def run(rmse: float = 0.02, peak: float = 0.2, gained: float = 10.0) -> Score:
    return Score(SlipMetrics(rmse, peak, 5.0, 50.0, 0.8), gained, 0.98, 0.0, None)


def test_five_percent_worse_is_not_worse() -> None:
    assert worse_in(run(rmse=0.0209, peak=0.209, gained=9.51), run()) == []


def test_each_figure_that_falls_behind_is_named() -> None:
    assert worse_in(run(rmse=0.0211), run()) == ["RMSE"]
    assert worse_in(run(peak=0.211), run()) == ["peak"]
    assert worse_in(run(gained=9.49), run()) == ["gain"]


def test_a_peak_below_the_reference_is_no_overshoot() -> None:
    assert worse_in(run(peak=0.1), run(peak=0.03)) == []
    assert worse_in(run(peak=0.11), run(peak=0.03)) == ["peak"]


def test_where_the_car_slows_down_slowing_down_more_is_worse() -> None:
    assert worse_in(run(gained=-1.04), run(gained=-1.0)) == []
    assert worse_in(run(gained=-1.06), run(gained=-1.0)) == ["gain"]


def test_where_the_reference_was_out_of_reach_there_is_no_rmse_to_fall_behind_in() -> None:
    assert worse_in(run(rmse=math.nan), run(rmse=math.nan)) == []


def test_the_librarys_table_counts_the_scenarios_in_which_a_law_holds() -> None:
    rows = [Row(name, law, run()) for name in ("ice", "hill") for law in ("pi", "kmpc", "nmpc")]
    rows[2] = Row("ice", "nmpc", run(peak=0.5))
    lines = against_the_yardstick(rows)
    assert "kmpc in 2 of 2, nmpc in 1 of 2" in lines[-1]
    ice = next(line for line in lines if line.startswith("| ice"))
    assert ice.endswith("| 0.0200 / 0.500 / 10.00 | peak |")
