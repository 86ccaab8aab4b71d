"""A first signal map from the names and units in a DBC, for its owner to correct."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

from cantools.database.can import Database as CanDatabase
from cantools.database.can import Message, Signal

from tcs_hil.canbus.mapping.advice import CHECKING, COUNTING
from tcs_hil.canbus.mapping.units import Kind, unit_of, units_for

OTHER_KINDS = "sum, sum-complement, crc8-j1850, crc8-h2f"
AXLES = (
    ("inputs.driver_torque_axle", "inputs.driver_torque_left"),
    ("limits.axle", "limits.left"),
)
"""Keys for both motors at once, which those for one each make needless."""
_WORDS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+")
_CORNERS = {
    "fl": {"fl", "lf", "vl", "frle", "frontleft", "leftfront"},
    "fr": {"fr", "rf", "vr", "frri", "frontright", "rightfront"},
    "rl": {"rl", "lr", "hl", "rele", "rearleft", "leftrear"},
    "rr": {"rr", "hr", "reri", "rearright", "rightrear"},
}
_LEFT, _RIGHT = {"l", "le", "left"}, {"r", "ri", "right"}
_MOTOR = {"mot", "motor", "inv", "inverter", "em", "edu", "drive"}
_REQUEST = {"req", "request", "demand", "dem", "ped", "pedal", "driver"}
_LIMIT = {"lim", "limit", "max", "ceiling"}
_FORWARD = {"ax", "long", "lon", "longitudinal"}


class Role(NamedTuple):
    """What a signal may be for: a key of the map, and how its signal would be called."""

    key: str
    kind: Kind
    place: str  # a corner, a side, or nothing
    words: frozenset[str]
    other_words: frozenset[str]


def _roles() -> Iterator[Role]:
    nothing: frozenset[str] = frozenset()
    motor, request, limit = frozenset(_MOTOR), frozenset(_REQUEST), frozenset(_LIMIT)
    for corner in _CORNERS:
        yield Role(f"inputs.wheel_speed_{corner}", Kind.WHEEL_SPEED, corner, nothing, motor)
    for side in ("left", "right"):
        yield Role(f"inputs.motor_speed_{side}", Kind.MOTOR_SPEED, side, motor, nothing)
    for side in ("left", "right"):
        yield Role(f"inputs.motor_torque_{side}", Kind.TORQUE, side, motor, request | limit)
    for side, key in (("left", "left"), ("right", "right"), ("", "axle")):
        yield Role(f"inputs.driver_torque_{key}", Kind.TORQUE, side, request, limit)
    yield Role("inputs.accel_x", Kind.ACCELERATION, "", frozenset(_FORWARD), nothing)
    for side, key in (("left", "left"), ("right", "right"), ("", "axle")):
        yield Role(f"limits.{key}", Kind.TORQUE, side, limit, request)


ROLES = tuple(_roles())


def propose(dbc: CanDatabase, path: str) -> str:
    """Configuration with a map of what was found; what was not is named in comments."""
    found = {role.key: candidate for role in ROLES for candidate in _best(dbc, role)}
    for axle, left in AXLES:
        if left in found:
            found.pop(axle, None)
    lines = [
        f"# By the names and units in {path}: look at every line, then run `tcs-hil map check`.",
        "[bus]",
        f"database = {json.dumps(path)}",
    ]
    for table in ("inputs", "limits"):
        lines += ["", f"[map.{table}]"]
        lines += [_line(role.key, found) for role in ROLES if role.key.startswith(table)]
    for message in {message.name: message for message, _ in found.values()}.values():
        lines += ["", *_message_table(message)]
    return "\n".join([*lines, ""])


def _best(dbc: CanDatabase, role: Role) -> list[tuple[Message, Signal]]:
    """The candidate with the finest steps; of none nothing."""
    candidates = [
        (message, signal)
        for message in dbc.messages
        for signal in message.signals
        if _suits(message, signal, role)
    ]
    return sorted(candidates, key=lambda candidate: abs(candidate[1].scale))[:1]


def _suits(message: Message, signal: Signal, role: Role) -> bool:
    own = [word.lower() for word in _WORDS.findall(signal.name)]
    if unit_of(signal.unit or "") not in units_for(role.kind) or _place(own, role) != role.place:
        return False
    known = {*own, *(word.lower() for word in _WORDS.findall(message.name))}
    wanted = not role.words or not role.words.isdisjoint(known)
    return wanted and role.other_words.isdisjoint(known)


def _place(words: list[str], role: Role) -> str:
    if role.kind is Kind.WHEEL_SPEED:
        # WheelFrLe is front left: two words that make a corner count before one that does.
        pairs = {first + second for first, second in pairwise(words)}
        for spoken in (pairs, set(words)):
            for corner, names in _CORNERS.items():
                if not names.isdisjoint(spoken):
                    return corner
        return ""
    if role.kind is Kind.ACCELERATION or _LEFT.isdisjoint(words) == _RIGHT.isdisjoint(words):
        return ""
    return "right" if _LEFT.isdisjoint(words) else "left"


def _line(key: str, found: dict[str, tuple[Message, Signal]]) -> str:
    name = key.partition(".")[2]
    if key not in found:
        return f"# {name}: nothing is called like it"
    message, signal = found[key]
    return f'{name} = {{ signal = "{message.name}.{signal.name}" }} # in {signal.unit}'


def _message_table(message: Message) -> Iterator[str]:
    """What the DBC does not say, or says by the names of its signals only."""
    names = [signal.name for signal in message.signals]
    counters = [name for name in names if COUNTING.search(name)]
    checksums = [name for name in names if CHECKING.search(name) and name not in counters]
    yield f"[map.messages.{message.name}]"
    if not message.cycle_time:
        yield "# cycle_ms: the DBC does not say"
    if counters:
        yield f"counter = {{ signals = {json.dumps(counters)} }} # lowest bits first"
    if checksums:
        yield f'# checksum = {{ signal = "{checksums[0]}", kind = "xor" }} # or {OTHER_KINDS}'
