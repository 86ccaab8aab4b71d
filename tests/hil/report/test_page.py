"""What the page holds, and that it holds everything it needs."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec
import numpy as np
import pytest
from hil.driven import LAUNCH, launch
from hil.report.made_page import BROKEN, DRIVEN, made_report
from msgspec import structs

from plant_emulator.expect import Expect
from plant_emulator.faults import Fault
from tcs_hil.hil.judging.evidence import Evidence
from tcs_hil.hil.report.picture import Line, Picture, Span, take


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> str:
    return made_report(tmp_path_factory.mktemp("report")).read_text(encoding="utf-8")


def test_the_page_asks_nobody_for_anything(page: str) -> None:
    assert "default-src 'none'" in page
    assert not re.search(r"<(link|script|img)[^>]+(src|href)=\"(?!data:)", page)
    assert "@import" not in page


def test_what_a_scenario_says_is_text_and_never_markup(page: str) -> None:
    assert "<b>bus</b>" not in page
    assert page.count("</script>") == page.count("<script")


def test_every_case_has_a_row_and_every_run_a_picture(page: str) -> None:
    assert f'id="{DRIVEN}"' in page
    assert f'id="{BROKEN}"' in page
    assert f'data-picture="{DRIVEN}"' in page
    assert f'data-picture="{BROKEN}"' not in page


def test_an_earlier_run_stands_beside(tmp_path: Path) -> None:
    earlier, now = tmp_path / "earlier", tmp_path / "now"
    made_report(earlier)
    assert f'data-earlier="{DRIVEN}"' in made_report(now, earlier).read_text(encoding="utf-8")


def test_a_hundred_such_cases_fit_into_an_email(tmp_path: Path) -> None:
    traces = take(launch()).traces
    assert 100 * len(msgspec.json.encode(traces)) < 5e6 * launch().end_s


def told() -> Picture:
    """The launch as if it had had a fault and limits."""
    scenario = structs.replace(
        LAUNCH,
        fault=(Fault(target="WheelSpeedFL", kind="stuck", start_s=0.1, end_s=0.2),),
        expect=(
            Expect(metric="peak slip", op="<", value=0.3, from_s=0.1),
            Expect(signal="bus.TorqueLimitL", op="<=", value=250.0),
            Expect(signal="service.state", op="!=", value="FAULT"),
        ),
    )
    return take(Evidence(launch().files, scenario, launch().config, "in-process"))


def test_faults_and_limits_are_in_the_picture() -> None:
    picture = told()
    assert picture.faults == [Span("WheelSpeedFL stuck", 0.1, 0.2)]
    slip, limit = picture.limits
    assert slip.channels == ["truth.slip_ratio_fl", "truth.slip_ratio_fr"]
    assert limit == Line(["bus.TorqueLimitL"], "<=", 250.0, 0.0, None)
    assert "bus.TorqueLimitL" in picture.traces.names
    assert picture.labels["service.state"]["FAULT"] == 5.0


def test_without_a_clock_the_law_is_timed_instead_of_the_latency() -> None:
    histogram = told().histogram
    assert histogram is not None
    assert histogram.what == "control law, per wheel"
    asked = np.isfinite(launch().ticks["proposal_fl_nm"]).sum()
    assert sum(histogram.counts) == 2 * asked
