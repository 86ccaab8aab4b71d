"""AUTOSAR E2E Profiles 1 and 2: the CRC is autosar-e2e's.

In both, byte 0 is the CRC and the low nibble of byte 1 the counter (AUTOSAR FO
PRS E2E Protocol).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from e2e.p01 import (
    E2E_P01_DATAID_ALT,
    E2E_P01_DATAID_BOTH,
    E2E_P01_DATAID_LOW,
    E2E_P01_DATAID_NIBBLE,
    e2e_p01_check,
    e2e_p01_protect,
)

from tcs_hil.canbus.e2e import COUNTER_MASK, Checker, E2ESpec, E2EStatus, Protector
from tcs_hil.canbus.mapping.counter import Succession

DataIdMode = Literal["both", "alternating", "low", "nibble"]

P01_HIGHEST = 14
"""Highest count of Profile 1; 15 is reserved."""

_MODES: dict[DataIdMode, int] = {
    "both": E2E_P01_DATAID_BOTH,
    "alternating": E2E_P01_DATAID_ALT,
    "low": E2E_P01_DATAID_LOW,
    "nibble": E2E_P01_DATAID_NIBBLE,
}


@dataclass(frozen=True, slots=True)
class Profile1:
    """A data id of 16 bits that goes into the CRC as ``mode`` says."""

    data_id: int
    mode: DataIdMode
    max_step: int

    def checker(self) -> Profile1Checker:
        """Make a receiver's side."""
        return Profile1Checker(self)

    def protector(self) -> Profile1Protector:
        """Make a sender's side."""
        return Profile1Protector(self)


class Profile1Checker:
    """Receiver's side of one message of Profile 1."""

    def __init__(self, spec: Profile1) -> None:
        self._data_id = spec.data_id
        self._mode = _MODES[spec.mode]
        self._succession = Succession(P01_HIGHEST, spec.max_step)

    def check(self, payload: bytes) -> E2EStatus:
        """Judge the next frame of the message."""
        mutable = bytearray(payload)  # the library takes no bytes here
        if not e2e_p01_check(mutable, self._data_id, data_id_mode=self._mode):
            return E2EStatus.ERROR
        return self._succession.judge(payload[1] & COUNTER_MASK)


class Profile1Protector:
    """Sender's side of one message of Profile 1."""

    def __init__(self, spec: Profile1) -> None:
        self._data_id = spec.data_id
        self._mode = _MODES[spec.mode]
        self._count = 0

    def protect(self, payload: bytearray) -> None:
        """Write the next counter and the CRC."""
        payload[1] |= self._count
        e2e_p01_protect(payload, self._data_id, data_id_mode=self._mode)
        self._count = payload[1] & COUNTER_MASK


@dataclass(frozen=True, slots=True)
class Profile2:
    """What our own DBC uses."""

    spec: E2ESpec

    def checker(self) -> Checker:
        """Make a receiver's side."""
        return Checker(self.spec)

    def protector(self) -> Protector:
        """Make a sender's side."""
        return Protector(self.spec)
