"""What a car must do to be the plant; the shipped ones and anybody's own look like this."""

from __future__ import annotations

from typing import Protocol

from plant_emulator.inverter import Demand
from plant_emulator.truth import Row


class Car(Protocol):
    """What a variant of the car must do."""

    def advance(self, demand: Demand, time_s: float, duration_s: float, /) -> None:
        """Integrate from ``time_s`` over ``duration_s``, in which demands are straight lines."""
        ...

    def observe(self, demand: Demand, row: Row, /) -> None:
        """Fill the car's part into a row of the truth."""
        ...
