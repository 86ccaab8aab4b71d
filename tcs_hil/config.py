"""TOML files into frozen, bounded structs; what does not fit is refused in one sentence."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Annotated, TypeVar

import msgspec
from msgspec import inspect

from tcs_hil.errors import ConfigError, offer

T = TypeVar("T")

FilePath = Annotated[str, msgspec.Meta(pattern=r"^[^\0]+$")]
"""A path that a file may have; relative ones are relative to the file that names it."""

Name = Annotated[str, msgspec.Meta(pattern=r"\S")]
"""Text with something in it."""

WORDS = {
    "Object contains unknown field": "unknown key",
    "Object missing required field": "missing key",
    "Invalid enum value": "unknown value",
    " | null": "",  # TOML has none
}
"""msgspec's, and those of this project."""
UNKNOWN = re.compile(r"unknown (?:key|value) .(.*).")
STEP = re.compile(r"\w+|\.{3}")  # `map.messages[...].counter`, `fault[0].kind`


def read_toml(path: Path, struct: type[T]) -> T:
    """Read ``path`` as a ``struct``.

    Raises:
        ConfigError: the file is missing or unreadable, is not TOML, or has an
            unknown key or a value out of its bounds; file and key are named.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise ConfigError(f"{path}: cannot be read (not UTF-8 text)") from error
    except ValueError as error:  # no name a file can have
        raise ConfigError(f"{str(path)!r}: cannot be read ({error})") from error
    try:
        table = tomllib.loads(text)
    except ValueError as error:  # broken TOML, or a number of thousands of digits
        raise ConfigError(f"{path}: not valid TOML: {error}") from error
    except RecursionError as error:
        raise ConfigError(f"{path}: not valid TOML: nested too deeply") from error
    return convert(table, struct, str(path))


def convert(table: object, struct: type[T], source: str) -> T:
    """Check a table of plain values against ``struct``; ``source`` opens the error's sentence."""
    try:
        return msgspec.convert(table, struct)
    except (msgspec.ValidationError, UnicodeDecodeError) as error:
        # msgspec may cut a name it quotes within a character: UnicodeDecodeError.
        raise ConfigError(f"{source}: {_one_sentence(str(error), struct)}") from error
    except RecursionError as error:
        raise ConfigError(f"{source}: nested too deeply") from error


def _one_sentence(message: str, struct: type) -> str:
    """``Object contains unknown field `x` - at `$.bus``` becomes ``bus: unknown key `x```.

    A name that is unknown is followed by those that are known.
    """
    what, _, where = message.partition(" - at `$")
    key = where.strip("`").lstrip(".")
    for theirs, ours in WORDS.items():
        what = what.replace(theirs, ours)
    if name := UNKNOWN.fullmatch(what):
        what += offer(name[1], _known(inspect.type_info(struct), STEP.findall(key)))
    return f"{key}: {what}" if key else what


def _known(kind: inspect.Type, way: list[str]) -> list[str]:
    """Keys of the table, or values of the choice, that lies the ``way`` of keys down."""
    if isinstance(kind, inspect.UnionType):  # of one such thing and null
        return max((_known(each, way) for each in kind.types), key=len)
    if isinstance(kind, inspect.StructType):
        fields = {field.encode_name: field.type for field in kind.fields}
        return _known(fields[way[0]], way[1:]) if way else list(fields)
    if isinstance(kind, inspect.DictType) and way:
        return _known(kind.value_type, way[1:])
    if isinstance(kind, inspect.VarTupleType) and way:
        return _known(kind.item_type, way[1:])
    return [str(value) for value in kind.values] if isinstance(kind, inspect.LiteralType) else []
