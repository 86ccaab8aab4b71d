"""The DBC as the code uses it: validated once, compiled, frozen."""

from __future__ import annotations

import importlib.resources
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import cast

import cantools
from cantools.database.can import Database as CanDatabase
from cantools.database.can import Message, Signal
from cantools.database.errors import UnsupportedDatabaseFormatError

from tcs_hil.canbus.codec import Codec, SignalSpec, compile_codec
from tcs_hil.canbus.contract import CONTRACT, MessageContract
from tcs_hil.canbus.e2e import E2ESpec
from tcs_hil.canbus.e2e_state import WindowSpec
from tcs_hil.canbus.protection import check_protection, check_window
from tcs_hil.canbus.validation import check_identifiers, check_message
from tcs_hil.errors import DatabaseError

DBC_ENCODING = "cp1252"  # what the DBC format prescribes


@dataclass(frozen=True, slots=True)
class MessageSpec:
    """One message of the contract: ``signals`` in the contract's order, codec alike.

    ``cycle_ns`` is 0 for a message that is sent on demand, ``e2e`` None for one
    that carries no protection.
    """

    name: str
    frame_id: int
    length: int
    cycle_ns: int
    sender: str
    signals: tuple[SignalSpec, ...]
    codec: Codec
    e2e: E2ESpec | None
    window: WindowSpec

    def signal(self, name: str) -> SignalSpec:
        """Look a signal of the contract up by name."""
        return next(signal for signal in self.signals if signal.name == name)


@dataclass(frozen=True, slots=True)
class Database:
    """Every message of the contract by name; ``source`` says where it was read."""

    source: str
    messages: Mapping[str, MessageSpec]

    def frame_ids_of(self, sender: str) -> frozenset[int]:
        """Identifiers only this node may send."""
        return frozenset(s.frame_id for s in self.messages.values() if s.sender == sender)


def load_database(path: Path | None = None) -> Database:
    """Read, validate and compile a DBC; the one that ships with the package by default.

    Raises:
        DatabaseError: The file cannot be read, or lacks something the service
            needs; names the message and the signal.
    """
    return _built_in() if path is None else _load(path)


@cache
def _built_in() -> Database:
    """Read once, whoever asks: a bench drives many cars in one process."""
    return _load(None)


def _load(path: Path | None) -> Database:
    source, parsed = parse_dbc(path)
    try:
        messages = {contract.name: _message_spec(parsed, contract) for contract in CONTRACT}
        check_identifiers({name: spec.frame_id for name, spec in messages.items()})
    except DatabaseError as error:
        raise DatabaseError(f"{source}: {error}") from error
    return Database(source, messages)


def parse_dbc(path: Path | None = None) -> tuple[str, CanDatabase]:
    """Read a DBC as cantools sees it, and say where it came from.

    Raises:
        DatabaseError: The file cannot be read or is no DBC.
    """
    source = str(path) if path is not None else "the built-in tcs.dbc"
    return source, _parse(source, _read(source, path))


def _read(source: str, path: Path | None) -> str:
    origin = path if path is not None else importlib.resources.files(__package__) / "tcs.dbc"
    try:
        return origin.read_text(encoding=DBC_ENCODING)
    except OSError as error:
        raise DatabaseError(f"{source}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise DatabaseError(f"{source}: cannot be read ({error})") from error


def _parse(source: str, text: str) -> CanDatabase:
    try:
        parsed = cantools.database.load_string(text, database_format="dbc", prune_choices=False)
    except UnsupportedDatabaseFormatError as error:
        sentence = " ".join(str(error.e_dbc).split())
        raise DatabaseError(f"{source} is not a valid DBC: {sentence}") from error
    return cast(CanDatabase, parsed)  # the union with a diagnostics database is for CDD files


def _message_spec(parsed: CanDatabase, contract: MessageContract) -> MessageSpec:
    message = check_message(parsed, contract)
    signals = tuple(
        signal_spec(message, message.get_signal_by_name(name)) for name in contract.signals
    )
    return MessageSpec(
        name=message.name,
        frame_id=message.frame_id,
        length=message.length,
        cycle_ns=(message.cycle_time or 0) * 1_000_000,
        sender=contract.sender,
        signals=signals,
        codec=compile_codec(message.name, message.length, signals),
        e2e=check_protection(message) if contract.protected else None,
        window=check_window(message),
    )


def signal_spec(message: Message, signal: Signal) -> SignalSpec:
    """Take a signal over from cantools, which has checked that it fits its message."""
    raw_labels: Mapping[int, object] = signal.choices or {}
    return SignalSpec(
        name=signal.name,
        shift=_shift(message, signal),
        length=signal.length,
        big_endian=signal.byte_order == "big_endian",
        signed=signal.is_signed,
        scale=signal.scale,
        offset=signal.offset,
        minimum=float(signal.minimum or 0),
        maximum=float(signal.maximum or 0),
        labels={
            str(label): raw * signal.scale + signal.offset for raw, label in raw_labels.items()
        },
    )


def _shift(message: Message, signal: Signal) -> int:
    if signal.byte_order == "little_endian":
        return signal.start
    # A Motorola start bit is the highest bit; DBC counts bits up from the right of each byte.
    bits_before = 8 * (signal.start // 8) + 7 - signal.start % 8
    return 8 * message.length - bits_before - signal.length
