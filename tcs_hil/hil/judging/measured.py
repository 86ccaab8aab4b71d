"""What a measurement gives, and what keeps one from being made."""

from __future__ import annotations

from typing import NamedTuple

from tcs_hil.errors import TcsError


class Measured(NamedTuple):
    """A value, the time it belongs to if it has one, and what is worth knowing about it."""

    value: float
    at_s: float | None = None
    note: str = ""


class CannotJudgeError(TcsError):
    """The run holds nothing that could tell; the sentence says what is missing."""
