"""Where the ceilings and their flags go, looked up in the DBC."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

from cantools.database.can import Database as CanDatabase
from cantools.database.can import Message, Signal

from tcs_hil.canbus.codec import SignalSpec
from tcs_hil.canbus.mapping.findings import Findings, MapFault
from tcs_hil.canbus.mapping.limit_code import LimitCode, limit_code
from tcs_hil.canbus.mapping.lookup import find_message, find_signal, page_of, spec_of
from tcs_hil.canbus.mapping.plan import MappedField, raw
from tcs_hil.canbus.mapping.resolve_input import check_fits
from tcs_hil.canbus.mapping.scale import in_si, unit_named
from tcs_hil.canbus.mapping.settings import ActiveSettings, LimitSettings, SignalMap
from tcs_hil.canbus.mapping.units import Kind
from tcs_hil.model.vehicle import Vehicle
from tcs_hil.signals import Command

_CEILINGS: dict[str, Callable[[Command], float]] = {
    "left": lambda command: command.limits.left_nm,
    "right": lambda command: command.limits.right_nm,
    "axle": lambda command: min(command.limits),
}
_FLAGS: dict[str, Callable[[Command], bool]] = {
    "active_left": lambda command: command.active[0],
    "active_right": lambda command: command.active[1],
    "active": lambda command: any(command.active),
}


class LimitResolver:
    """Looks the limits of one map up in one DBC."""

    def __init__(self, dbc: CanDatabase, settings: SignalMap, vehicle: Vehicle) -> None:
        self._dbc = dbc
        self._map = settings
        self._vehicle = vehicle
        self.codes: dict[str, LimitCode] = {}

    def fields(self, findings: Findings) -> Iterator[MappedField]:
        """Every signal that is to be sent, and into ``codes`` what the ceilings can say."""
        limits = self._map.limits
        for key in (*_CEILINGS, *_FLAGS):
            settings = getattr(limits, key)
            if isinstance(settings, LimitSettings):
                yield from findings.collect(self._ceiling, key, settings)
            elif isinstance(settings, ActiveSettings):
                yield from findings.collect(self._flag, key, settings)

    def fixed(self, message_name: str) -> Iterator[MappedField]:
        """Signals of a message that goes out that never change.

        Raises:
            MapFault: A signal is missing or too narrow for its value.
        """
        key = f"messages.{message_name}.fixed"
        message = find_message(self._dbc, message_name, key)
        for name, value in self._fixed_values(message_name).items():
            spec = spec_of(message, find_signal(message, name, key))
            check_fits(spec, value, key)
            yield MappedField(key, message.name, raw(spec), _constant(value))

    def _ceiling(self, name: str, settings: LimitSettings) -> MappedField:
        key = f"limits.{name}"
        message, signal = self._find(settings.signal, key)
        unit = unit_named(settings, signal, Kind.TORQUE, key)
        bits = spec_of(message, signal)
        if settings.no_limit_raw is not None:
            check_fits(bits, settings.no_limit_raw, f"{key}.no_limit_raw")
        spec = in_si(bits, settings, unit, Kind.TORQUE, self._vehicle, name == "axle")
        code = self.codes[name] = limit_code(spec, settings.no_limit_raw, key)
        ceiling = _CEILINGS[name]
        return MappedField(
            key, message.name, _unbounded(spec), lambda command: code.to_bus(ceiling(command))
        )

    def _flag(self, name: str, settings: ActiveSettings) -> MappedField:
        key = f"limits.{name}"
        message, signal = self._find(settings.signal, key)
        spec = spec_of(message, signal)
        for value in (settings.active_raw, settings.inactive_raw):
            check_fits(spec, value, key)
        is_active, values = _FLAGS[name], (settings.inactive_raw, settings.active_raw)
        return MappedField(key, message.name, raw(spec), lambda command: values[is_active(command)])

    def _find(self, path: str, key: str) -> tuple[Message, Signal]:
        message_name, _, signal_name = path.partition(".")
        message = find_message(self._dbc, message_name, key)
        signal = find_signal(message, signal_name, key)
        fixed = self._fixed_values(message_name)
        for selector in page_of(message, signal):
            if fixed.get(selector.signal.name) not in selector.values:
                values = ", ".join(map(str, sorted(selector.values)))
                raise MapFault(
                    key,
                    f"{path} is multiplexed; fix {selector.signal.name} to {values} "
                    f"under messages.{message_name}.fixed",
                )
        return message, signal

    def _fixed_values(self, message_name: str) -> dict[str, int]:
        settings = self._map.messages.get(message_name)
        return {} if settings is None else settings.fixed


def _constant(value: int) -> Callable[[Command], float]:
    return lambda _command: value


def _unbounded(spec: SignalSpec) -> SignalSpec:
    """Without the DBC's range, out of which the code for "no limit" often lies."""
    bits = raw(spec)
    return replace(
        spec,
        minimum=bits.minimum * spec.scale + spec.offset,
        maximum=bits.maximum * spec.scale + spec.offset,
    )
