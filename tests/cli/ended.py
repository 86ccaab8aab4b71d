"""How a command ended, and what it said."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple


class Ended(NamedTuple):
    """One call of ``tcs-hil``."""

    status: int
    out: str
    err: str

    def is_one_sentence_about(self, *culprits: str) -> bool:
        """Whether it was refused as every mistake of a user is."""
        told = self.err.startswith("tcs-hil: error: ") and self.err.count("\n") == 1
        return self.status == 2 and told and all(culprit in self.err for culprit in culprits)


TcsHil = Callable[..., Ended]
"""Runs ``tcs-hil`` with these arguments."""
