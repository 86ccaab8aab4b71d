"""One input of the map looked up in the DBC."""

from __future__ import annotations

from collections.abc import Iterator

from cantools.database.can import Database as CanDatabase
from cantools.database.can import Message

from tcs_hil.canbus.codec import SignalSpec
from tcs_hil.canbus.mapping.findings import MapFault
from tcs_hil.canbus.mapping.lookup import find_message, find_signal, page_of, spec_of
from tcs_hil.canbus.mapping.plan import (
    AXLE_INPUT,
    KINDS,
    MappedInput,
    Page,
    RangeRule,
    RawRule,
    Rule,
    raw,
)
from tcs_hil.canbus.mapping.scale import in_si, unit_named
from tcs_hil.canbus.mapping.settings import FlagSettings, InputSettings
from tcs_hil.model.vehicle import Vehicle


def resolve_input(
    dbc: CanDatabase, name: str, settings: InputSettings, vehicle: Vehicle
) -> MappedInput:
    """Find the signal of an input, and what its values mean.

    Raises:
        MapFault: Something is not in the DBC, or cannot mean what it should.
    """
    key = f"inputs.{name}"
    message_name, _, signal_name = settings.signal.partition(".")
    message = find_message(dbc, message_name, key)
    signal = find_signal(message, signal_name, key)
    if settings.factor == 0:
        raise MapFault(key, "a factor of 0 leaves nothing of the signal")
    unit = unit_named(settings, signal, KINDS[name], key)
    spec, page = spec_of(message, signal), page_of(message, signal)
    return MappedInput(
        message=message.name,
        unit=unit,
        value=in_si(spec, settings, unit, KINDS[name], vehicle, name == AXLE_INPUT),
        page=page,
        rules=tuple(_rules(message, spec, page, settings, key)),
    )


def _rules(
    message: Message, spec: SignalSpec, page: Page, settings: InputSettings, key: str
) -> Iterator[Rule]:
    if settings.valid_when is not None:
        yield _flag_rule(message, page, settings.valid_when, f"{key}.valid_when")
    if settings.invalid_raw:
        for value in settings.invalid_raw:
            check_fits(spec, value, f"{key}.invalid_raw")
        yield RawRule(raw(spec), frozenset(settings.invalid_raw), wanted=False)
    if settings.valid_range is not None:
        low, high = settings.valid_range
        if low > high:
            raise MapFault(f"{key}.valid_range", f"the range {low:g} to {high:g} is empty")
        yield RangeRule(spec, low, high)


def _flag_rule(message: Message, page: Page, flag: FlagSettings, key: str) -> RawRule:
    signal = find_signal(message, flag.signal, key)
    if not all(selector in page for selector in page_of(message, signal)):
        raise MapFault(key, f"{flag.signal} is not in every frame that has the signal it is for")
    spec = spec_of(message, signal)
    for value in flag.equals:
        check_fits(spec, value, key)
    return RawRule(raw(spec), frozenset(flag.equals), wanted=True)


def check_fits(spec: SignalSpec, value: int, key: str) -> None:
    """Check that the bits of a signal can hold a raw value.

    Raises:
        MapFault: They cannot.
    """
    bits = raw(spec)
    if not bits.minimum <= value <= bits.maximum:
        raise MapFault(
            key,
            f"raw value {value} does not fit the {spec.length} bits of {spec.name} "
            f"({bits.minimum:g} to {bits.maximum:g})",
        )
