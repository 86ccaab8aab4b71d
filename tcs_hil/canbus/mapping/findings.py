"""What looking a signal map over has found: sentences, and how much each matters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import Enum
from typing import NamedTuple, ParamSpec, TypeVar

T = TypeVar("T")
P = ParamSpec("P")


class Weight(Enum):
    """With an ERROR the service cannot run; with a WARNING it runs worse than it could."""

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


class Finding(NamedTuple):
    """One sentence about one key of the map."""

    weight: Weight
    key: str
    sentence: str


class MapFault(Exception):  # noqa: N818 - a value on its way to the findings, caught there
    """What makes a key of the map unusable; ends the look at this key alone."""

    def __init__(self, key: str, sentence: str) -> None:
        super().__init__(f"{key}: {sentence}")
        self.finding = Finding(Weight.ERROR, key, sentence)


@dataclass(slots=True)
class Findings:
    """Collects what is found on the way, so that a user hears of everything at once."""

    found: list[Finding] = field(default_factory=list)

    def error(self, key: str, sentence: str) -> None:
        """Take down what keeps the service from running."""
        self._add(Finding(Weight.ERROR, key, sentence))

    def warn(self, key: str, sentence: str) -> None:
        """Take down what the service runs worse with."""
        self._add(Finding(Weight.WARNING, key, sentence))

    def note(self, key: str, sentence: str) -> None:
        """Take down what is good to know."""
        self._add(Finding(Weight.NOTE, key, sentence))

    def collect(self, make: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> list[T]:
        """What ``make`` returns, as a list of one; of none where it found a fault."""
        try:
            return [make(*args, **kwargs)]
        except MapFault as fault:
            self._add(fault.finding)
            return []

    @property
    def errors(self) -> list[Finding]:
        """Those that keep the service from running."""
        return [finding for finding in self.found if finding.weight is Weight.ERROR]

    def _add(self, finding: Finding) -> None:
        # A message that is both read and written is looked at twice.
        if finding not in self.found:
            self.found.append(finding)
