"""What a scenario tells a bench: the control law to start, and the limits the run must keep.

The plant reads neither; the bench judges (``tcs-hil hil``, docs/hil.md).
"""

from __future__ import annotations

from typing import Literal

from plant_emulator.bounds import NonNegative, Positive, Table

Op = Literal["<", "<=", ">", ">=", "==", "!="]


class ControllerTable(Table, frozen=True):
    """Which control law a bench starts against this scenario."""

    kind: Literal["off", "pi", "kmpc", "nmpc"] = "nmpc"
    preset: Literal["paper", "default"] = "default"


class Expect(Table, frozen=True):
    """A limit on a signal in every sample of the window, or on a metric over it.

    A metric of one signal names both, and the ``target`` and ``band`` it needs.
    ``value`` and ``target`` are in the unit of what is measured, or a label of it,
    such as a state.  Names are the bench's, which refuses those it does not know.
    """

    op: Op
    value: float | str
    signal: str | None = None
    metric: str | None = None
    target: float | str | None = None
    band: Positive | None = None
    from_s: NonNegative = 0.0
    to_s: Positive | None = None

    def __post_init__(self) -> None:
        """Refuse a limit on nothing, or over an empty window."""
        if self.signal is None and self.metric is None:
            raise ValueError("give `signal`, `metric` or both")
        if self.to_s is not None and self.to_s <= self.from_s:
            raise ValueError("`to_s` must be greater than `from_s`")
