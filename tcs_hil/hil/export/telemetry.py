"""The flight recording as a table: what the service knew, decided and took, tick by tick."""

from __future__ import annotations

from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tcs_hil.control.protocol import SolveStatus
from tcs_hil.fault_codes import FaultCode
from tcs_hil.hil.export.table import Channel, Instants, Table
from tcs_hil.names import unit_of
from tcs_hil.signals import BusCondition, ControllerKind, TcsState

COMMENT = "What the service knew, decided and took, tick by tick (flight recording)"

ENUMERATIONS: dict[str, type[IntEnum]] = {
    "state": TcsState,
    "fault_code": FaultCode,
    "controller": ControllerKind,
    "bus_condition": BusCondition,
    "status_fl": SolveStatus,
    "status_fr": SolveStatus,
}


def telemetry_table(ticks: NDArray[np.void], time_ns: Instants) -> Table:
    """Every field of ticks as ``recording.read`` returns them, (n,)."""
    names = ticks.dtype.names or ()
    return Table(
        "telemetry", COMMENT, time_ns, tuple(_channel(name, ticks[name]) for name in names)
    )


def _channel(name: str, values: NDArray[Any]) -> Channel:
    labels = {int(member): member.name for member in ENUMERATIONS.get(name, ())}
    numbers = values.astype(np.uint8) if values.dtype == np.bool_ else values
    return Channel(name, np.ascontiguousarray(numbers), unit_of(name), labels=labels)
