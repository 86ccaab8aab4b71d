"""A signal map and a DBC in, a plan out; everything that is wrong with them is found at once."""

from __future__ import annotations

from collections import defaultdict

from cantools.database.can import Database as CanDatabase

from tcs_hil.canbus.codec import SignalSpec
from tcs_hil.canbus.mapping.completeness import check_complete, check_directions, check_used
from tcs_hil.canbus.mapping.findings import Findings, MapFault
from tcs_hil.canbus.mapping.lookup import find_message
from tcs_hil.canbus.mapping.plan import (
    KINDS,
    MappedField,
    MappedInput,
    MappedMessage,
    MappedOutput,
    Plan,
)
from tcs_hil.canbus.mapping.resolve_input import resolve_input
from tcs_hil.canbus.mapping.resolve_limits import LimitResolver
from tcs_hil.canbus.mapping.resolve_protection import resolve_protection
from tcs_hil.canbus.mapping.room import check_room
from tcs_hil.canbus.mapping.settings import MessageSettings, SignalMap
from tcs_hil.model.vehicle import Vehicle


def resolve(dbc: CanDatabase, settings: SignalMap, vehicle: Vehicle, findings: Findings) -> Plan:
    """Look every key of the map up; the plan is whole only where ``findings`` has no errors."""
    resolver = _Resolver(dbc, settings, findings)
    inputs = resolver.inputs(vehicle)
    limits = LimitResolver(dbc, settings, vehicle)
    plan = Plan(inputs, resolver.received(inputs), resolver.outputs(limits), limits.codes)
    check_complete(settings, findings)
    check_used(settings, findings)
    check_directions(plan, findings)
    return plan


class _Resolver:
    def __init__(self, dbc: CanDatabase, settings: SignalMap, findings: Findings) -> None:
        self._dbc = dbc
        self._map = settings
        self._findings = findings

    def inputs(self, vehicle: Vehicle) -> dict[str, MappedInput]:
        found = {}
        for name in KINDS:
            settings = getattr(self._map.inputs, name)
            if settings is not None:
                for mapped in self._findings.collect(
                    resolve_input, self._dbc, name, settings, vehicle
                ):
                    found[name] = mapped
        return found

    def received(self, inputs: dict[str, MappedInput]) -> dict[str, MappedMessage]:
        by_message = defaultdict(list)
        for mapped in inputs.values():
            by_message[mapped.message].append(mapped)
        return {
            message.name: message
            for mapped in by_message.values()
            for message in self._findings.collect(self._received, mapped)
        }

    def outputs(self, limits: LimitResolver) -> tuple[MappedOutput, ...]:
        by_message = defaultdict(list)
        for field in limits.fields(self._findings):
            by_message[field.message].append(field)
        return tuple(
            output
            for name, sent in by_message.items()
            for output in self._findings.collect(self._output, name, sent, limits)
        )

    def _received(self, inputs: list[MappedInput]) -> MappedMessage:
        message = self._message(inputs[0].message)
        for mapped in inputs:
            # One by one: signals on different pages of a multiplexer may share bits.
            self._check_room(message.name, [mapped.value])
        return message

    def _output(self, name: str, sent: list[MappedField], limits: LimitResolver) -> MappedOutput:
        message = self._message(name)
        fields = (*sent, *limits.fixed(name))
        self._check_room(name, [field.signal for field in fields])
        return MappedOutput(message, fields)

    def _message(self, name: str) -> MappedMessage:
        key = f"messages.{name}"
        message = find_message(self._dbc, name, key)
        settings = self._settings(name)
        cycle_ms = settings.cycle_ms or message.cycle_time
        if not cycle_ms:
            raise MapFault(key, f"the DBC gives no cycle time of {name}; give cycle_ms")
        protection = resolve_protection(message, settings)
        return MappedMessage(name, message.frame_id, message.length, cycle_ms, protection)

    def _check_room(self, name: str, signals: list[SignalSpec]) -> None:
        key = f"messages.{name}"
        check_room(find_message(self._dbc, name, key), self._settings(name), signals, key)

    def _settings(self, name: str) -> MessageSettings:
        return self._map.messages.get(name, MessageSettings())
