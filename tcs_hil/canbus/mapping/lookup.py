"""Finding messages and signals of a DBC by name, with the nearest ones where there is none."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import replace

from cantools.database.can import Database as CanDatabase
from cantools.database.can import Message, Signal

from tcs_hil.canbus.codec import SignalSpec
from tcs_hil.canbus.database import signal_spec
from tcs_hil.canbus.mapping.findings import MapFault
from tcs_hil.canbus.mapping.plan import Page, RawRule, raw
from tcs_hil.canbus.validation import CLASSIC_LENGTH


def find_message(dbc: CanDatabase, name: str, key: str) -> Message:
    """Find a message that a port of ours can carry.

    Raises:
        MapFault: There is none, or it needs CAN FD or 29-bit identifiers.
    """
    for message in dbc.messages:
        if message.name == name:
            return _carried(message, key)
    names = [message.name for message in dbc.messages]
    raise MapFault(key, f"the DBC has no message {name}{_nearest(name, names)}")


def find_signal(message: Message, name: str, key: str) -> Signal:
    """Find a signal of integer bits.

    Raises:
        MapFault: There is none, or it is a floating-point signal.
    """
    for signal in message.signals:
        if signal.name == name:
            if signal.is_float:
                raise MapFault(key, f"{message.name}.{name} is a floating-point signal")
            return signal
    names = [signal.name for signal in message.signals]
    raise MapFault(key, f"message {message.name} has no signal {name}{_nearest(name, names)}")


def spec_of(message: Message, signal: Signal) -> SignalSpec:
    """Bits and scale of a signal; without a range in the DBC, all its bits can say."""
    spec = signal_spec(message, signal)
    if spec.minimum < spec.maximum:
        return spec
    whole = raw(spec)
    ends = sorted(end * spec.scale + spec.offset for end in (whole.minimum, whole.maximum))
    return replace(spec, minimum=ends[0], maximum=ends[1])


def page_of(message: Message, signal: Signal) -> Page:
    """Multiplexers, outermost last, and what they read while ``signal`` is in the frame."""
    page: list[RawRule] = []
    while signal.multiplexer_signal is not None:
        selector = message.get_signal_by_name(signal.multiplexer_signal)
        values = frozenset(signal.multiplexer_ids or ())
        page.append(RawRule(raw(spec_of(message, selector)), values, wanted=True))
        signal = selector
    return tuple(page)


def _carried(message: Message, key: str) -> Message:
    if message.is_extended_frame:
        raise MapFault(
            key,
            f"message {message.name} has the 29-bit identifier {message.frame_id:#x}; "
            "the service speaks 11-bit ones only",
        )
    if message.is_fd or message.length > CLASSIC_LENGTH:
        raise MapFault(
            key, f"message {message.name} is CAN FD; the service speaks classic CAN only"
        )
    return message


def _nearest(name: str, names: Iterable[str]) -> str:
    by_lower_case = {candidate.lower(): candidate for candidate in names}
    near = difflib.get_close_matches(name.lower(), by_lower_case, n=3, cutoff=0.5)
    if not near:
        return ""
    return f"; near it: {', '.join(by_lower_case[candidate] for candidate in near)}"
