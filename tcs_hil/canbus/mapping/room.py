"""Whether signals and protection of a message leave each other their bits."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from cantools.database.can import Message

from tcs_hil.canbus.codec import SignalSpec
from tcs_hil.canbus.mapping.findings import MapFault
from tcs_hil.canbus.mapping.lookup import find_signal, spec_of
from tcs_hil.canbus.mapping.resolve_protection import BYTE_BITS, PROFILE_BYTES
from tcs_hil.canbus.mapping.settings import MessageSettings

PROFILE_HEADER = 0xFF0F
"""Bits of the first two bytes that E2E Profiles 1 and 2 claim."""


def check_room(
    message: Message, settings: MessageSettings, used: Iterable[SignalSpec], key: str
) -> None:
    """Check that no two of the signals used share a bit, nor any with the protection.

    Raises:
        MapFault: Names the signal that is in the way.
    """
    taken = 0
    if settings.e2e is not None:
        taken = PROFILE_HEADER << BYTE_BITS * (message.length - PROFILE_BYTES)
    for spec in (*_protection_signals(message, settings, key), *used):
        bits = _bits(spec, message.length)
        if bits & taken:
            raise MapFault(
                key,
                f"{message.name}.{spec.name} lies on bits of the counter, of the checksum or of "
                "another signal that is sent",
            )
        taken |= bits


def _protection_signals(
    message: Message, settings: MessageSettings, key: str
) -> Iterator[SignalSpec]:
    names = [] if settings.counter is None else list(settings.counter.signals)
    names += [] if settings.checksum is None else [settings.checksum.signal]
    for name in names:
        yield spec_of(message, find_signal(message, name, key))


def _bits(spec: SignalSpec, length: int) -> int:
    """Bits of a signal, in the frame read as one big-endian number."""
    bits = spec.mask << spec.shift
    return bits if spec.big_endian else int.from_bytes(bits.to_bytes(length, "little"), "big")
