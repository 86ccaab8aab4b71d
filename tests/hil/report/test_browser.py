"""The page as a reader sees it: a real browser loads it, opens a case, zooms and filters."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import pytest
from hil.report.browser import Page, open_page
from hil.report.made_page import DRIVEN, made_report

CASE = f"document.getElementById({json.dumps(DRIVEN)})"
PLOTS = f"{CASE}.querySelector('.detail > td').plots"
INKED = """[...document.querySelectorAll("canvas")].map((canvas) => {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  return new Set(new Uint32Array(data.buffer)).size;
})"""
SPANS = f"{PLOTS}.slice(0, -1).map((plot) => plot.scales.x.max - plot.scales.x.min)"
BOX = f"(({{ x, y, width }}) => ({{ x, y, width }}))({PLOTS}[0].over.getBoundingClientRect())"
SHOWN = '[...document.querySelectorAll("tbody.case")].filter((each) => !each.hidden).length'
NEXT_FRAME = "new Promise((go) => requestAnimationFrame(() => requestAnimationFrame(() => go(0))))"


@pytest.fixture(scope="module", params=["light", "dark"])
def page(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Page]:
    report = made_report(tmp_path_factory.mktemp("report"))
    with open_page() as page:
        scheme = [{"name": "prefers-color-scheme", "value": request.param}]
        page.call("Emulation.setEmulatedMedia", features=scheme)
        page.load(report)
        yield page


@pytest.fixture(scope="module")
def opened(page: Page) -> Page:
    assert page.run('document.querySelectorAll("canvas").length') == 0
    page.run(f"toggle({CASE}, true)")
    page.run(NEXT_FRAME)
    return page


def test_every_plot_of_a_case_is_drawn_once_it_is_opened(opened: Page) -> None:
    colours = opened.run(INKED)
    assert len(colours) >= 7
    assert min(colours) > 3


def test_the_console_stays_silent_and_nothing_is_asked_of_a_network(opened: Page) -> None:
    assert opened.complaints == []
    assert [url[:5] for url in opened.requests] == ["file:"]


def test_what_one_plot_is_zoomed_to_all_plots_of_the_case_are(opened: Page) -> None:
    whole = opened.run(SPANS)
    opened.run(f"{PLOTS}[0].root.scrollIntoView({{ block: 'center' }})")
    drag(opened, opened.run(BOX))
    zoomed = opened.run(SPANS)
    assert len(zoomed) >= 6
    for before, after in zip(whole, zoomed, strict=True):
        assert after == pytest.approx(0.5 * before, rel=0.05)


def drag(page: Page, box: dict[str, Any]) -> None:
    """From a quarter of a plot to three quarters."""
    begin, end, height = box["x"] + 0.25 * box["width"], box["x"] + 0.75 * box["width"], 30.0
    page.mouse("Moved", begin, box["y"] + height)
    page.mouse("Pressed", begin, box["y"] + height)
    page.run(NEXT_FRAME)
    page.mouse("Moved", end, box["y"] + height)
    page.run(NEXT_FRAME)
    page.mouse("Released", end, box["y"] + height)
    page.run(NEXT_FRAME)


def test_a_click_on_a_verdict_filters_and_so_do_words(opened: Page) -> None:
    opened.run('document.querySelector(".chip.failed").click()')
    assert opened.run(SHOWN) == 1
    opened.run('document.querySelector(".chip").click()')
    assert opened.run(SHOWN) == 2
    opened.run('search.value = "broken"; search.dispatchEvent(new Event("input"))')
    assert opened.run(SHOWN) == 1
    opened.run('search.value = ""; search.dispatchEvent(new Event("input"))')
