"""What a DBC must hold before the service trusts it."""

from __future__ import annotations

import math
from collections.abc import Mapping

from cantools.database.can import Database as CanDatabase
from cantools.database.can import Message, Signal

from tcs_hil.canbus.contract import (
    NO_LIMIT_LABEL,
    NO_LIMIT_SIGNALS,
    VALUE_TABLES,
    WHEEL_SPEED_RESOLUTION_RADPS,
    WHEEL_SPEEDS,
    MessageContract,
)
from tcs_hil.canbus.e2e import DATA_ID_COUNT, E2ESpec
from tcs_hil.errors import DatabaseError

CLASSIC_LENGTH = 8
COUNTER_RANGE = 15

# Start bit and length by byte order: a Motorola start bit is the highest bit.
_CRC_PLACE = {"little_endian": (0, 8), "big_endian": (7, 8)}
_COUNTER_PLACE = {"little_endian": (8, 4), "big_endian": (11, 4)}


def check_message(parsed: CanDatabase, contract: MessageContract) -> Message:
    """Find the contract's message and check it with every signal of it.

    Raises:
        DatabaseError: Names the message and, where one is at fault, the signal.
    """
    message = _find_message(parsed, contract.name)
    _check_frame(message, contract)
    for name in contract.signals:
        _check_signal(message, _find_signal(message, name), contract.receiver)
    return message


def check_protection(message: Message) -> E2ESpec:
    """Check and read the E2E Profile 2 attributes of a protected message.

    Raises:
        DatabaseError: An attribute is missing or malformed, or the CRC or the
            counter is not where Profile 2 wants it.
    """
    if str(_attribute(message, "E2EProfile")) != "P02":
        raise _fault(message, "needs the attribute E2EProfile P02")
    _check_place(message, f"{message.name}Crc", _CRC_PLACE, "byte 0")
    _check_place(message, f"{message.name}Counter", _COUNTER_PLACE, "the low nibble of byte 1")
    return E2ESpec(_data_ids(message), _max_delta_counter(message))


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


def _find_signal(message: Message, name: str) -> Signal:
    for signal in message.signals:
        if signal.name == name:
            return signal
    raise _fault(message, "is missing", name)


def _check_frame(message: Message, contract: MessageContract) -> None:
    if message.is_extended_frame:
        raise _fault(message, "has an extended identifier; only 11-bit ones are used")
    if message.length > CLASSIC_LENGTH:
        raise _fault(message, f"is longer than the {CLASSIC_LENGTH} bytes of classic CAN")
    if message.is_multiplexed():
        raise _fault(message, "is multiplexed, which is not supported")
    if contract.sender not in message.senders:
        raise _fault(message, f"must be sent by node {contract.sender}")
    if contract.cyclic and not message.cycle_time:
        raise _fault(message, "has no cycle time (attribute GenMsgCycleTime)")


def _check_signal(message: Message, signal: Signal, receiver: str) -> None:
    if signal.is_float:
        raise _fault(message, "is a floating-point signal, which is not supported", signal.name)
    if not signal.unit:
        raise _fault(message, 'has no unit ("-" for none)', signal.name)
    if not signal.comment:
        raise _fault(message, "has no comment", signal.name)
    if receiver not in signal.receivers:
        raise _fault(message, f"must be received by node {receiver}", signal.name)
    if not _has_range(signal):
        raise _fault(message, "has no range", signal.name)
    if not 0 < signal.scale < math.inf or not math.isfinite(signal.offset):
        raise _fault(message, "must have a positive factor and a finite offset", signal.name)
    _check_meaning(message, signal)


def _has_range(signal: Signal) -> bool:
    low, high = signal.minimum, signal.maximum
    return low is not None and high is not None and -math.inf < low < high < math.inf


def _check_meaning(message: Message, signal: Signal) -> None:
    name = signal.name
    labels = {raw: str(label) for raw, label in (signal.choices or {}).items()}
    if name in WHEEL_SPEEDS and signal.scale > WHEEL_SPEED_RESOLUTION_RADPS:
        limit = f"{WHEEL_SPEED_RESOLUTION_RADPS} rad/s"
        raise _fault(message, f"has steps of {signal.scale} rad/s, coarser than {limit}", name)
    if name in VALUE_TABLES and labels != {int(m): m.name for m in VALUE_TABLES[name]}:
        expected = ", ".join(f"{int(m)} {m.name}" for m in VALUE_TABLES[name])
        raise _fault(message, f"needs the value table {expected}", name)
    if name in NO_LIMIT_SIGNALS and labels != {_highest_raw(signal): NO_LIMIT_LABEL}:
        raise _fault(message, f'must call its highest raw value "{NO_LIMIT_LABEL}"', name)


def _highest_raw(signal: Signal) -> int:
    return (1 << signal.length - signal.is_signed) - 1


def _check_place(
    message: Message, name: str, places: dict[str, tuple[int, int]], where: str
) -> None:
    signal = _find_signal(message, name)
    if (signal.start, signal.length) != places[signal.byte_order]:
        raise _fault(message, f"must fill {where} (E2E Profile 2)", name)


def _data_ids(message: Message) -> bytes:
    text = str(_attribute(message, "E2EDataIdList"))
    try:
        data_ids = bytes.fromhex(text)
    except ValueError:
        data_ids = b""
    if len(data_ids) != DATA_ID_COUNT:
        raise _fault(message, f"needs {DATA_ID_COUNT} bytes in hex as attribute E2EDataIdList")
    return data_ids


def _max_delta_counter(message: Message) -> int:
    value = _attribute(message, "E2EMaxDeltaCounter")
    if not isinstance(value, int) or not 1 <= value < COUNTER_RANGE:
        raise _fault(message, f"needs the attribute E2EMaxDeltaCounter in 1 to {COUNTER_RANGE - 1}")
    return value


def _attribute(message: Message, name: str) -> object:
    attributes = message.dbc.attributes if message.dbc is not None else {}
    if name not in attributes:
        return None
    attribute = attributes[name]
    choices, value = attribute.definition.choices, attribute.value
    # An enumeration is stored as its index by some tools and as its text by others.
    if not choices or not isinstance(value, int):
        return value
    return choices[value] if 0 <= value < len(choices) else None


def _fault(message: Message, what: str, signal: str | None = None) -> DatabaseError:
    part = "" if signal is None else f"signal {signal} of "
    return DatabaseError(f"{part}message {message.name} {what}")
