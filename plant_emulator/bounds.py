"""Bounds a scenario's numbers are checked against, and the table they stand in."""

from __future__ import annotations

from typing import Annotated

import msgspec
from msgspec import Meta

MOST = 1e9
"""More than any quantity of a car; without it infinity and not-a-number would pass."""

TEETH_MAX = 200

Positive = Annotated[float, Meta(gt=0.0, le=MOST)]
NonNegative = Annotated[float, Meta(ge=0.0, le=MOST)]
Finite = Annotated[float, Meta(ge=-MOST, le=MOST)]
Ratio = Annotated[float, Meta(ge=0.0, le=1.0)]
Seed = Annotated[int, Meta(ge=0, lt=2**32)]


class Table(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A TOML table: read once, never changed, unknown keys refused."""
