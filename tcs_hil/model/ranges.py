"""Bounds of quantities: a pair that must rise."""

from __future__ import annotations

from typing import Annotated

import msgspec

Bounded = Annotated[float, msgspec.Meta(ge=-1e5, le=1e5)]
"""Any quantity of a car in SI units; neither infinite nor a slip of the pen."""
Range = tuple[Bounded, Bounded]
Period = Annotated[float, msgspec.Meta(ge=1e-4, le=0.1)]
"""Sampling time in s."""


def check_rising(settings: msgspec.Struct) -> None:
    """Raise ValueError, which msgspec turns into its own error, for a pair that does not rise."""
    for name in settings.__struct_fields__:
        value = getattr(settings, name)
        if isinstance(value, tuple) and not value[0] < value[1]:
            raise ValueError(f"{name} must rise, not run from {value[0]} to {value[1]}")


def range_of(values: list[float]) -> Range:
    """Smallest and largest of some values."""
    return min(values), max(values)
