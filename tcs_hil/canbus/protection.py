"""What the DBC's attributes say about the E2E protection of a message."""

from __future__ import annotations

from cantools.database.can import Message

from tcs_hil.canbus.e2e import DATA_ID_COUNT, E2ESpec
from tcs_hil.canbus.e2e_state import Threshold, WindowSpec
from tcs_hil.canbus.validation import fault, find_signal

COUNTER_RANGE = 15
LARGEST_WINDOW = 64

# Start bit and length by byte order: a Motorola start bit is the highest bit.
_CRC_PLACE = {"little_endian": (0, 8), "big_endian": (7, 8)}
_COUNTER_PLACE = {"little_endian": (8, 4), "big_endian": (11, 4)}


def check_protection(message: Message) -> E2ESpec:
    """Check and read the E2E Profile 2 attributes of a protected message.

    Raises:
        DatabaseError: An attribute is missing or malformed, or the CRC or the
            counter is not where Profile 2 wants it.
    """
    if str(_attribute(message, "E2EProfile")) != "P02":
        raise fault(message, "needs the attribute E2EProfile P02")
    _check_place(message, f"{message.name}Crc", _CRC_PLACE, "byte 0")
    _check_place(message, f"{message.name}Counter", _COUNTER_PLACE, "the low nibble of byte 1")
    return E2ESpec(_data_ids(message), _number(message, "E2EMaxDeltaCounter", 1, COUNTER_RANGE - 1))


def check_window(message: Message) -> WindowSpec:
    """Check and read the attributes of a message's E2E state machine.

    Raises:
        DatabaseError: An attribute is missing or out of range, or VALID would
            be easier to reach than to keep.
    """
    size = _number(message, "E2EWindowSize", 1, LARGEST_WINDOW)
    init, valid, invalid = (_threshold(message, s, size) for s in ("Init", "Valid", "Invalid"))
    for state, entry in (("Init", init), ("Invalid", invalid)):
        if entry.min_ok < valid.min_ok:
            raise fault(message, f"has an E2EMinOk{state} below its E2EMinOkValid")
        if entry.max_error > valid.max_error:
            raise fault(message, f"has an E2EMaxError{state} above its E2EMaxErrorValid")
    return WindowSpec(size, init, valid, invalid)


def _threshold(message: Message, state: str, size: int) -> Threshold:
    return Threshold(
        min_ok=_number(message, f"E2EMinOk{state}", 1, size),
        max_error=_number(message, f"E2EMaxError{state}", 0, size),
    )


def _check_place(
    message: Message, name: str, places: dict[str, tuple[int, int]], where: str
) -> None:
    signal = find_signal(message, name)
    if (signal.start, signal.length) != places[signal.byte_order]:
        raise fault(message, f"must fill {where} (E2E Profile 2)", name)


def _data_ids(message: Message) -> bytes:
    text = str(_attribute(message, "E2EDataIdList"))
    try:
        data_ids = bytes.fromhex(text)
    except ValueError:
        data_ids = b""
    if len(data_ids) != DATA_ID_COUNT:
        raise fault(message, f"needs {DATA_ID_COUNT} bytes in hex as attribute E2EDataIdList")
    return data_ids


def _number(message: Message, name: str, low: int, high: int) -> int:
    value = _attribute(message, name)
    if not isinstance(value, int) or not low <= value <= high:
        raise fault(message, f"needs the attribute {name} in {low} to {high}")
    return value


def _attribute(message: Message, name: str) -> object:
    """Value of the attribute, else the DBC's default for it, else None."""
    specifics = message.dbc
    definition = specifics.attribute_definitions.get(name) if specifics is not None else None
    if specifics is None or definition is None:
        return None
    given = specifics.attributes.get(name)
    value = definition.default_value if given is None else given.value
    # An enumeration is stored as its index by some tools and as its text by others.
    if not definition.choices or not isinstance(value, int):
        return value
    return definition.choices[value] if 0 <= value < len(definition.choices) else None
