"""What came of a case, and of a suite: figures and verdicts, as they are kept in a file."""

from __future__ import annotations

from pathlib import Path

import msgspec

from tcs_hil.errors import ConfigError
from tcs_hil.hil.judging.verdict import Finding, Verdict, overall

FILE = "results.json"

FIGURES = ("slip RMSE", "peak slip", "speed gained ratio", "mean |dT/dt|", "limit cycles")
CLOCKED_FIGURES = ("latency p99", "latency max", "overruns")
"""Metrics every run is told by, whatever its scenario limits; those of a clock in real time."""


class Result(msgspec.Struct, frozen=True, kw_only=True):
    """One case.

    ``figures`` are metrics of the whole run by name, None where there is nothing
    to measure; ``error`` is why the run did not come about, empty if it did.
    """

    name: str
    suite: str
    description: str
    controller: str
    preset: str
    mode: str
    verdict: Verdict
    findings: list[Finding]
    figures: dict[str, float | None]
    wall_s: float
    error: str = ""

    @property
    def reason(self) -> str:
        """Why the verdict is what it is, in one line; empty for one that passed."""
        telling = [each for each in self.findings if each.verdict is self.verdict]
        if self.error or self.verdict is Verdict.PASSED:
            return self.error
        return _line(telling) if telling else "nothing was judged"


class SuiteResult(msgspec.Struct, frozen=True, kw_only=True):
    """Every case of one run of the bench, and what it was run with."""

    title: str
    command: str
    started: str
    machine: str
    versions: dict[str, str]
    jobs: int
    wall_s: float
    results: list[Result]

    @property
    def verdict(self) -> Verdict:
        """Failed if any case failed, blocked if any is blocked, else passed."""
        return overall(result.verdict for result in self.results)

    def count(self, verdict: Verdict) -> int:
        """How many cases came to ``verdict``."""
        return sum(result.verdict is verdict for result in self.results)

    def save(self, folder: Path) -> None:
        """Write everything into the folder, for a later run to be compared with."""
        (folder / FILE).write_bytes(msgspec.json.format(msgspec.json.encode(self)))


def load_results(folder: Path) -> SuiteResult:
    """Read what an earlier run has left.

    Raises:
        ConfigError: the folder holds no such file, or one that cannot be read.
    """
    path = folder / FILE
    try:
        return msgspec.json.decode(path.read_bytes(), type=SuiteResult)
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read ({error.strerror})") from error
    except msgspec.DecodeError as error:
        raise ConfigError(f"{path}: is not what `tcs-hil hil` writes: {error}") from error


def _line(findings: list[Finding]) -> str:
    first = findings[0]
    more = f" (and {len(findings) - 1} more)" if len(findings) > 1 else ""
    return f"{first.limit}: {first.reason}{more}"
