"""Putting the page together: markup, styles, program and data in one file."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from types import MappingProxyType
from typing import Any

import msgspec
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from tcs_hil.errors import ConfigError
from tcs_hil.hil.judging.of_run import RUN_METRICS
from tcs_hil.hil.judging.verdict import Verdict
from tcs_hil.hil.report import picture
from tcs_hil.hil.suite.result import CLOCKED_FIGURES, FIGURES, Result, SuiteResult

ASSETS = files(__package__) / "assets"
FILE = "index.html"
NO_FIGURES: Mapping[str, Path] = MappingProxyType({})


def write_report(
    folder: Path,
    suite: SuiteResult,
    baseline: tuple[Path, SuiteResult] | None = None,
    figures: Mapping[str, Path] = NO_FIGURES,
) -> Path:
    """Write the page of a suite whose runs are in ``folder``; returns its path.

    ``baseline`` is the folder and the results of an earlier run to stand beside;
    ``figures`` are PNG files by title, shown above the cases.

    Raises:
        ConfigError: the page cannot be written.
    """
    environment = Environment(
        loader=PackageLoader("tcs_hil.hil.report"), autoescape=True, undefined=StrictUndefined
    )
    environment.filters |= {"figure": _figure, "change": _change}
    before = {} if baseline is None else {each.name: each for each in baseline[1].results}
    page = environment.get_template("report.html.j2").render(
        suite=suite,
        counts={verdict: suite.count(verdict) for verdict in Verdict},
        columns=_columns(suite),
        figures={title: _inline(image) for title, image in figures.items()},
        rows=[(result, before.get(result.name)) for result in _worst_first(suite)],
        baseline=None if baseline is None else baseline[1],
        pictures=_pictures(folder, suite),
        earlier={} if baseline is None else _pictures(baseline[0], suite),
        asset=_asset,
        embedded=_embedded,
    )
    path = folder / FILE
    try:
        path.write_text(page, encoding="utf-8")
    except OSError as error:
        raise ConfigError(f"{path}: cannot be written ({error.strerror})") from error
    return path


def _worst_first(suite: SuiteResult) -> list[Result]:
    order = (Verdict.FAILED, Verdict.BLOCKED, Verdict.PASSED)
    return sorted(suite.results, key=lambda result: order.index(result.verdict))


def _columns(suite: SuiteResult) -> dict[str, str]:
    """Metrics in the table, with their units: those of a clock only where one was there."""
    clocked = any(result.mode == "real-time" for result in suite.results)
    names = (*FIGURES, *(CLOCKED_FIGURES if clocked else ()))
    return {name: RUN_METRICS[name].unit for name in names}


def _inline(image: Path) -> str:
    return base64.b64encode(image.read_bytes()).decode()


def _figure(value: float) -> str:
    if abs(value) >= 10.0 or value.is_integer():
        return f"{value:.0f}"
    return f"{value:.3f}" if abs(value) >= 0.1 else f"{value:.4f}"


def _change(value: float) -> str:
    return f"{value:+.2g}"


def _pictures(folder: Path, suite: SuiteResult) -> dict[str, Markup]:
    """By case, as JSON text; a run that did not come about has none."""
    found = {}
    for result in suite.results:
        path = folder / "runs" / result.name / picture.FILE
        if path.is_file():
            found[result.name] = _inert(path.read_text(encoding="utf-8"))
    return found


def _embedded(results: list[tuple[Result, Any]]) -> Markup:
    """Results as JSON for the page's program."""
    return _inert(msgspec.json.encode([result for result, _ in results]).decode())


def _inert(json: str) -> Markup:
    """JSON that cannot end the element it stands in."""
    return Markup(json.replace("<", "\\u003c"))  # noqa: S704 - nothing of it is markup any more


def _asset(name: str) -> Markup:
    return Markup((ASSETS / name).read_text(encoding="utf-8"))  # noqa: S704 - our own files
