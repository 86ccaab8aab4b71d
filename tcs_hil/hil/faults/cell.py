"""A cell of the campaign: a fault, how long it lasts, and what the service owes it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import msgspec

from plant_emulator.faults import Fault
from tcs_hil.fault_codes import FaultCode
from tcs_hil.hil.faults.manoeuvres import FAULT_S, SLOW_MANOEUVRE
from tcs_hil.signals import TcsState


@dataclass(frozen=True, slots=True)
class Promise:
    """What the service owes a fault.

    It is named within ``named_s``, and the state is ``state`` or worse within
    ``within_s``; both are None where the fault need not be found, for the reason
    ``why``.  Nothing but ``codes`` may be named, and from ``back_s`` after the
    fault on nothing is.
    """

    codes: frozenset[FaultCode] = frozenset()
    state: TcsState = TcsState.DEGRADED
    named_s: float | None = None
    within_s: float | None = None
    back_s: float = 0.0
    why: str = ""


@dataclass(frozen=True, slots=True)
class Cell:
    """One fault: ``kind`` on each of ``targets``, for ``lasts_s``, as ``family`` says in words.

    ``slow_promise`` takes the place of ``promise`` where the car is at walking pace.
    """

    family: str
    targets: tuple[str, ...]
    kind: str
    promise: Promise
    lasts_s: float
    numbers: Mapping[str, float] = field(default_factory=dict)
    slow_promise: Promise | None = None

    def in_manoeuvre(self, manoeuvre: str) -> Cell:
        """The cell with what is owed there alone."""
        slow = self.slow_promise if manoeuvre == SLOW_MANOEUVRE else None
        return replace(self, promise=slow or self.promise, slow_promise=None)

    @property
    def name(self) -> str:
        """Unique in the campaign, and fit for a folder."""
        return f"{'+'.join(self.targets)}-{self.family}".replace("%", "percent").replace(" ", "-")

    @property
    def end_s(self) -> float:
        """When the fault ends."""
        return FAULT_S + self.lasts_s

    @property
    def faults(self) -> tuple[Fault, ...]:
        """The fault as a scenario lists it."""
        return tuple(self._fault(target) for target in self.targets)

    def _fault(self, target: str) -> Fault:
        described = {"target": target, "kind": self.kind, "start_s": FAULT_S, "end_s": self.end_s}
        return msgspec.convert(described | dict(self.numbers), Fault)
