"""AUTOSAR E2E Profile 2: the CRC comes from autosar-e2e, the counter's judgement is ours.

Byte 0 is the CRC, the low nibble of byte 1 the counter (AUTOSAR FO PRS E2E
Protocol, "Profile 2").
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Final

from e2e.p02 import e2e_p02_check, e2e_p02_protect

COUNTER_MASK: Final = 0x0F
DATA_ID_COUNT: Final = 16


@dataclass(frozen=True, slots=True)
class E2ESpec:
    """Protection of one message: a data id per counter value, and the tolerated loss.

    A counter that moved on by more than ``max_delta_counter`` since the last
    accepted frame is out of sequence.
    """

    data_ids: bytes  # (16,)
    max_delta_counter: int


class E2EStatus(IntEnum):
    """What one cycle of a message brought; the standard's profile status."""

    OK = 0
    REPEATED = 1
    WRONG_SEQUENCE = 2
    ERROR = 3
    NOT_AVAILABLE = 4  # no frame


OK: Final = E2EStatus.OK
REPEATED: Final = E2EStatus.REPEATED
ERROR: Final = E2EStatus.ERROR


class Protector:
    """Sender's side of one message: counts frames and signs them."""

    __slots__ = ("_counter", "_data_ids")

    def __init__(self, spec: E2ESpec) -> None:
        self._data_ids = spec.data_ids
        self._counter = 0

    def protect(self, payload: bytearray) -> None:
        """Write the next counter and the CRC into ``payload``, whose own are zero."""
        payload[1] |= self._counter
        e2e_p02_protect(payload, self._data_ids)
        self._counter = payload[1] & COUNTER_MASK


class Checker:
    """Receiver's side of one message, frame by frame."""

    __slots__ = ("_last_counter", "_spec")

    def __init__(self, spec: E2ESpec) -> None:
        self._spec = spec
        self._last_counter: int | None = None

    def check(self, payload: bytes) -> E2EStatus:
        """Judge the next frame of the message; its values count only when ``OK``."""
        if not e2e_p02_check(payload, self._spec.data_ids):
            return ERROR
        counter = payload[1] & COUNTER_MASK
        # The counter is taken over whatever it is: after a restart of the sender the next
        # frame in order is good again.
        last, self._last_counter = self._last_counter, counter
        return OK if last is None else self._judge_step((counter - last) & COUNTER_MASK)

    def _judge_step(self, delta: int) -> E2EStatus:
        if delta == 0:
            return REPEATED
        return OK if delta <= self._spec.max_delta_counter else E2EStatus.WRONG_SEQUENCE
