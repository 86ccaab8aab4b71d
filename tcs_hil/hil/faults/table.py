"""The campaign's results as Markdown: a row per fault, a column per law, worse manoeuvre first."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from string import ascii_lowercase

from tcs_hil.fault_codes import FaultCode
from tcs_hil.hil.faults.cell import Cell, Promise
from tcs_hil.hil.faults.judge import ABOVE, BACK, BEYOND, DETECT, MS, NAMED, REACT, RISE
from tcs_hil.hil.judging.verdict import Finding, Verdict
from tcs_hil.hil.suite.result import Result

NOTHING = "-"


def headings(results: Sequence[Result]) -> list[str]:
    """Of the columns of `rows`."""
    return ["fault", "owed", "named", *_laws(results), "passed"]


def rows(cells: Sequence[Cell], results: Sequence[Result]) -> Iterator[list[str]]:
    """One row per cell, in their order."""
    letters, driven = _letters(cells), _laws(results)
    for cell in cells:
        of_cell = [result for result in results if result.name.startswith(f"{cell.name}/")]
        laws = ([each for each in of_cell if each.controller == law] for law in driven)
        passed = sum(each.verdict is Verdict.PASSED for each in of_cell)
        yield [
            f"{' and '.join(f'`{target}`' for target in cell.targets)} {cell.family}",
            _owed(cell, letters),
            _named(of_cell),
            *(_figures(each) for each in laws),
            f"{passed} of {len(of_cell)}",
        ]


def summary(cells: Sequence[Cell], results: Sequence[Result], where: str) -> str:
    """The campaign in a few sentences; ``where`` it was driven, and at which pace."""
    passed = sum(result.verdict is Verdict.PASSED for result in results)
    owed = sum(cell.promise.within_s is not None for cell in cells)
    return (
        f"{len(cells)} faults, {owed} of which must be found, make {len(results)} runs {where}: "
        f"{passed} passed, {len(results) - passed} did not. In no tick of any run was a limit "
        f"more than {_worst(results, ABOVE):.3f} Nm above the request or did it rise more than "
        f"{_worst(results, BEYOND):.3f} Nm beyond its rate, which is half a step and a step of "
        f"the signal; the largest rise in a tick, by a law that was trusted, was "
        f"{_worst(results, RISE):.1f} Nm."
    )


def shortfalls(results: Sequence[Result]) -> list[str]:
    """Every run that did not pass, and why."""
    return [
        f"- `{result.name}` {result.verdict}: {result.reason}"
        for result in results
        if result.verdict is not Verdict.PASSED
    ]


def legend(cells: Sequence[Cell]) -> list[str]:
    """What the letters of `rows` stand for."""
    return [f"- *{letter}*: {why}." for why, letter in _letters(cells).items()]


def _laws(results: Sequence[Result]) -> list[str]:
    return list(dict.fromkeys(result.controller for result in results))


def _letters(cells: Sequence[Cell]) -> dict[str, str]:
    """A letter for every reason for which nothing is owed."""
    promises = (promise for cell in cells for promise in (cell.promise, cell.slow_promise))
    reasons = dict.fromkeys(promise.why for promise in promises if promise and promise.why)
    return dict(zip(reasons, ascii_lowercase, strict=False))


def _owed(cell: Cell, letters: Mapping[str, str]) -> str:
    owed = _in_words(cell.promise, letters)
    if cell.slow_promise is None:
        return owed
    return f"{owed}, at walking pace {_in_words(cell.slow_promise, letters)}"


def _in_words(promise: Promise, letters: Mapping[str, str]) -> str:
    if promise.within_s is None:
        return f"*{letters[promise.why]}*"
    if promise.within_s == 0.0:
        return f"{promise.state.name} at once"
    return f"{promise.state.name} in {promise.within_s * MS:.0f} ms"


def _named(results: Sequence[Result]) -> str:
    """Fault codes by number, in the order they came."""
    texts = [finding.reason for result in results for finding in _all(result, NAMED)]
    names = dict.fromkeys(name for text in texts for name in text.split(", ") if name)
    return ", ".join(str(FaultCode[name].value) for name in names) or NOTHING


def _figures(results: Sequence[Result]) -> str:
    """Named → answered, ms; largest rise in a tick, Nm; back, ms."""
    if not all(result.findings for result in results):
        return "not judged"
    named, answered = _times(results, DETECT), _times(results, REACT)
    found = named if named == answered else f"{named} → {answered}"
    return f"{found} · {_worst(results, RISE):.1f} · {_worst(results, BACK):.0f}"


def _times(results: Sequence[Result], name: str) -> str:
    """The worse time; both where one manoeuvre never shows it."""
    measured = [each.measured for result in results for each in _all(result, name)]
    known = [each for each in measured if each is not None]
    if not known:
        return NOTHING
    return f"{max(known):.0f}" + (f" or {NOTHING}" if len(known) < len(measured) else "")


def _worst(results: Sequence[Result], name: str) -> float:
    found = (each.measured for result in results for each in _all(result, name))
    return max((each for each in found if each is not None), default=float("nan"))


def _all(result: Result, name: str) -> Iterator[Finding]:
    return (finding for finding in result.findings if finding.limit.startswith(name))
