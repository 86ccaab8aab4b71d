"""What a DBC must hold before the service trusts it."""

from __future__ import annotations

import math
from collections.abc import Mapping

from cantools.database.can import Database as CanDatabase
from cantools.database.can import Message, Signal

from tcs_hil.canbus.contract import (
    HIGHEST_RAW_LABELS,
    VALUE_TABLES,
    WHEEL_SPEED_RESOLUTION_RADPS,
    WHEEL_SPEEDS,
    MessageContract,
)
from tcs_hil.errors import DatabaseError

CLASSIC_LENGTH = 8


def check_message(parsed: CanDatabase, contract: MessageContract) -> Message:
    """Find the contract's message and check it with every signal of it.

    Raises:
        DatabaseError: Names the message and, where one is at fault, the signal.
    """
    message = _find_message(parsed, contract.name)
    _check_frame(message, contract)
    for name in contract.signals:
        _check_signal(message, find_signal(message, name), contract.receiver)
    return message


def check_identifiers(frame_ids: Mapping[str, int]) -> None:
    """Check that no two messages share an identifier.

    Raises:
        DatabaseError: Names both messages.
    """
    owners: dict[int, str] = {}
    for name, frame_id in frame_ids.items():
        owner = owners.setdefault(frame_id, name)
        if owner != name:
            raise DatabaseError(f"messages {owner} and {name} share the identifier {frame_id:#x}")


def _find_message(parsed: CanDatabase, name: str) -> Message:
    for message in parsed.messages:
        if message.name == name:
            return message
    raise DatabaseError(f"message {name} is missing")


def find_signal(message: Message, name: str) -> Signal:
    """Find a signal of ``message``.

    Raises:
        DatabaseError: Names both where there is none of that name.
    """
    for signal in message.signals:
        if signal.name == name:
            return signal
    raise fault(message, "is missing", name)


def _check_frame(message: Message, contract: MessageContract) -> None:
    if message.is_extended_frame:
        raise fault(message, "has an extended identifier; only 11-bit ones are used")
    if message.length > CLASSIC_LENGTH:
        raise fault(message, f"is longer than the {CLASSIC_LENGTH} bytes of classic CAN")
    if message.is_multiplexed():
        raise fault(message, "is multiplexed, which is not supported")
    if contract.sender not in message.senders:
        raise fault(message, f"must be sent by node {contract.sender}")
    if contract.cyclic and not message.cycle_time:
        raise fault(message, "has no cycle time (attribute GenMsgCycleTime)")


def _check_signal(message: Message, signal: Signal, receiver: str) -> None:
    if signal.is_float:
        raise fault(message, "is a floating-point signal, which is not supported", signal.name)
    if not signal.unit:
        raise fault(message, 'has no unit ("-" for none)', signal.name)
    if not signal.comment:
        raise fault(message, "has no comment", signal.name)
    if receiver not in signal.receivers:
        raise fault(message, f"must be received by node {receiver}", signal.name)
    if not _has_range(signal):
        raise fault(message, "has no range", signal.name)
    if not 0 < signal.scale < math.inf or not math.isfinite(signal.offset):
        raise fault(message, "must have a positive factor and a finite offset", signal.name)
    _check_meaning(message, signal)


def _has_range(signal: Signal) -> bool:
    low, high = signal.minimum, signal.maximum
    return low is not None and high is not None and -math.inf < low < high < math.inf


def _check_meaning(message: Message, signal: Signal) -> None:
    name = signal.name
    labels = {raw: str(label) for raw, label in (signal.choices or {}).items()}
    if name in WHEEL_SPEEDS and signal.scale > WHEEL_SPEED_RESOLUTION_RADPS:
        limit = f"{WHEEL_SPEED_RESOLUTION_RADPS} rad/s"
        raise fault(message, f"has steps of {signal.scale} rad/s, coarser than {limit}", name)
    if name in VALUE_TABLES and labels != {int(m): m.name for m in VALUE_TABLES[name]}:
        expected = ", ".join(f"{int(m)} {m.name}" for m in VALUE_TABLES[name])
        raise fault(message, f"needs the value table {expected}", name)
    label = HIGHEST_RAW_LABELS.get(name)
    if label is not None and labels != {_highest_raw(signal): label}:
        raise fault(message, f'must call its highest raw value "{label}"', name)


def _highest_raw(signal: Signal) -> int:
    return (1 << signal.length - signal.is_signed) - 1


def fault(message: Message, what: str, signal: str | None = None) -> DatabaseError:
    """Sentence that says what is wrong with a message, or with one signal of it."""
    part = "" if signal is None else f"signal {signal} of "
    return DatabaseError(f"{part}message {message.name} {what}")
