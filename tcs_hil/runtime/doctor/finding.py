"""What a check has to say."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple


class Verdict(Enum):
    """``FAIL`` is a hard requirement that is missing; ``WARN`` costs punctuality."""

    OK = "ok"
    WARN = "warn"
    FAIL = "fail"


class Finding(NamedTuple):
    """One line of the doctor: ``remedy`` is the command, or the setting, that mends it."""

    what: str
    verdict: Verdict
    found: str
    remedy: str = ""


def ok(what: str, found: str) -> Finding:
    """Nothing to mend."""
    return Finding(what, Verdict.OK, found)


def warn(what: str, found: str, remedy: str) -> Finding:
    """It runs, but not as well as it could."""
    return Finding(what, Verdict.WARN, found, remedy)


def fail(what: str, found: str, remedy: str) -> Finding:
    """It does not run like this."""
    return Finding(what, Verdict.FAIL, found, remedy)
