"""Counter, checksum or E2E profile of a message looked up in the DBC."""

from __future__ import annotations

from cantools.database.can import Message

from tcs_hil.canbus.e2e import E2ESpec
from tcs_hil.canbus.mapping.checksums import CRC_KINDS, CRC_PRESET, Checksum
from tcs_hil.canbus.mapping.counter import Counter
from tcs_hil.canbus.mapping.findings import MapFault
from tcs_hil.canbus.mapping.homemade import Homemade
from tcs_hil.canbus.mapping.lookup import find_signal, spec_of
from tcs_hil.canbus.mapping.plan import raw
from tcs_hil.canbus.mapping.profiles import Profile1, Profile2
from tcs_hil.canbus.mapping.protection import Protection
from tcs_hil.canbus.mapping.settings import (
    ChecksumSettings,
    CounterSettings,
    MessageSettings,
    Profile1Settings,
    Profile2Settings,
)

BYTE_BITS = 8
PROFILE_BYTES = 2


def resolve_protection(message: Message, settings: MessageSettings) -> Protection | None:
    """Find the bits that protect a message; None where the map names none.

    Raises:
        MapFault: A signal is missing, or does not fit what it should hold.
    """
    key = f"messages.{message.name}"
    if settings.e2e is not None:
        if settings.counter is not None or settings.checksum is not None:
            raise MapFault(key, "an E2E profile brings its own counter and checksum; say one only")
        return _profile(message, settings.e2e, f"{key}.e2e")
    if settings.counter is None and settings.checksum is None:
        return None
    return Homemade(
        length=message.length,
        counter=_counter(message, settings.counter, f"{key}.counter"),
        checksum=_checksum(message, settings.checksum, f"{key}.checksum"),
    )


def _profile(
    message: Message, settings: Profile1Settings | Profile2Settings, key: str
) -> Profile1 | Profile2:
    if message.length < PROFILE_BYTES:
        raise MapFault(key, f"the header cannot fit the {message.length} bytes of {message.name}")
    if isinstance(settings, Profile1Settings):
        return Profile1(settings.data_id, settings.mode, settings.max_step)
    return Profile2(E2ESpec(bytes(settings.data_ids), settings.max_step))


def _counter(message: Message, settings: CounterSettings | None, key: str) -> Counter | None:
    if settings is None:
        return None
    parts = tuple(
        raw(spec_of(message, find_signal(message, name, key))) for name in settings.signals
    )
    most = (1 << sum(part.length for part in parts)) - 1
    highest = most if settings.highest is None else settings.highest
    if highest > most:
        raise MapFault(key, f"{', '.join(settings.signals)} can count to {most} only")
    return Counter(parts, highest, min(settings.max_step, highest))


def _checksum(message: Message, settings: ChecksumSettings | None, key: str) -> Checksum | None:
    if settings is None:
        return None
    spec = spec_of(message, find_signal(message, settings.signal, key))
    if spec.length != BYTE_BITS or spec.shift % BYTE_BITS:
        raise MapFault(
            key,
            f"{settings.kind} cannot fit {settings.signal}, which is {spec.length} bits and "
            "must be one whole byte",
        )
    byte = spec.shift // BYTE_BITS
    preset = CRC_PRESET if settings.kind in CRC_KINDS else 0
    data_id, before = bytes(settings.data_id), settings.data_id_place == "before"
    return Checksum(
        byte=message.length - 1 - byte if spec.big_endian else byte,
        kind=settings.kind,
        initial=preset if settings.initial is None else settings.initial,
        final_xor=preset if settings.final_xor is None else settings.final_xor,
        prefix=data_id if before else b"",
        suffix=b"" if before else data_id,
    )
